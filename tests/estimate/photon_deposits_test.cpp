#include "tools/estimate/photon_deposits.h"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/support/pipeline.h"

namespace bnvpl::test {
namespace {

// Deposits in the first of a few VPLs of the Cornell box, as if `photons` photons were sent.
class Deposits {
 public:
  explicit Deposits(uint64_t photons)
      : deposits(EstimateInputs{vpls_, world_.accel, world_.lights, {}, {}}, coverage_, 1.7f,
                 photons) {
    sums_.vpl.resize(vpls_.size());
    sums_.points = EmitPoints(vpls_, 4, 1);
  }
  // A hit at a place of its own, with this many times the flux of the mean photon.
  void hit(float relative) {
    SurfacePoint point;
    point.position = vpls_.position[0] + Vec3(1e-4f * static_cast<float>(++hits_), 0, 0);
    point.ng = point.ns = vpls_.normal[0];
    const ReachGrid::Lookup near = deposits.coverage().lookUp(point.position);
    const Vec3 flux(relative * static_cast<float>(deposits.photonPower()));
    deposits.deposit(0, {point, near, flux, true, false, 1.0f, 0}, flux, sums_);
  }
  const VplSum& sum() const { return sums_.vpl[0]; }

 private:
  const World world_{"cornell/scene.toml"};
  const VplTable vpls_ = keptVpls(world_, {{"count", "10"}}, {{"count", "100"}});
  const Coverage coverage_ = coverageOf(vpls_, world_.accel, 1.7f);
  PhotonSums sums_;
  size_t hits_ = 0;

 public:
  const PhotonDeposits deposits;
};

TEST(PhotonDeposits, APhotonOfHugeFluxDoesNotEndTheRun) {
  for (const uint64_t photons : {100'000u, 10'000'000u}) {
    Deposits d(photons);
    for (int i = 0; i < 10; ++i) d.hit(3e5f);
    EXPECT_GT(d.sum().squares, 0);
    EXPECT_GT(d.sum().squaresByPower, 0);
    EXPECT_TRUE(std::isfinite(std::sqrt(d.deposits.variance(d.sum()))));
  }
}

// The unit of many photons is coarse, and a guide makes photons faint.
TEST(PhotonDeposits, FaintPhotonsKeepTheirMeanFlux) {
  Deposits d(uint64_t{1} << 36);  // in units of 2^-18 of the mean photon
  constexpr int kHits = 100'000;
  constexpr float kRelative = 0x1p-18f * 1.3f;
  for (int i = 0; i < kHits; ++i) d.hit(kRelative);
  const double power = d.deposits.photonPower(), expected = kHits * double{kRelative} * power;
  EXPECT_NEAR(d.deposits.fixed().decode(d.sum().flux[1]) / expected, 1.0, 0.01);
  EXPECT_EQ(d.sum().flux, d.sum().firstBounce);
}

}  // namespace
}  // namespace bnvpl::test
