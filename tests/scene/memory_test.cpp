// Repeated loading takes no more memory than loading a few times.
#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>

#include "scene/load_scene.h"
#include "tests/support/sanitizers.h"
#include "transport/lights/lights.h"

namespace bnvpl {
namespace {

double residentMiB() {
  std::ifstream statm("/proc/self/statm");
  double total = 0.0, resident = 0.0;
  EXPECT_TRUE(statm >> total >> resident);
  return resident * static_cast<double>(::sysconf(_SC_PAGESIZE)) / (1 << 20);
}

void loadTimes(int times) {
  for (int i = 0; i < times; ++i) {
    const Scene scene = loadScene(fs::path(BNVPL_SCENES) / "veach-door/scene.toml");
    const Accelerator accel(scene);
    EXPECT_GT(mean(LightSet(accel).totalPower()), 0.0f);
    SurfacePoint hit;
    ASSERT_TRUE(accel.closestHit(scene.camera.position, {0.0f, -1.0f, 0.0f}, hit));
  }
}

TEST(Memory, LoadingAgainTakesNoMore) {
  if (kSanitized) GTEST_SKIP() << "sanitizers keep what is freed";
  // A leak grows in every round; memory that allocators and thread pools retain does not.
  double leastGrowth = std::numeric_limits<double>::infinity();
  loadTimes(4);
  for (int round = 0; round < 5; ++round) {
    const double before = residentMiB();
    loadTimes(15);
    leastGrowth = std::min(leastGrowth, residentMiB() - before);
  }
  EXPECT_LT(leastGrowth, 0.25) << "MiB for 15 times";
}

}  // namespace
}  // namespace bnvpl
