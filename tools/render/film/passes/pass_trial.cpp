#include "tools/render/film/passes/pass_trial.h"

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/render/film/passes/partial_film.h"
#include "tools/render/film/passes/passes.h"
#include "tools/render/film/tiles.h"

namespace bnvpl {

namespace {

constexpr size_t kTilesForEach = 64;  // tiles of the film for each tile of a trial
constexpr size_t kMinTiles = 64;      // tiles of a trial at least
constexpr size_t kWorthATrial = 512;  // tiles of a film
// A tile that learns the lights does so for itself and those around it, which share it later.
constexpr double kLearnTogether = 9.0;

// Seconds of `count` units that are tried in parallel.
template <typename Unit>
double secondsOf(size_t count, const Unit& unit) {
  const double startS = nowS();
  parallelFor(count, 1, unit);
  return nowS() - startS;
}

}  // namespace

uint32_t sppThatFits(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                     double timeS, double passes) {
  const Tiles tiles(scene.film);
  if (tiles.count() < kWorthATrial) return kPassSpp;
  const SpreadOrder order(tiles.count());
  const size_t tried = std::max(kMinTiles, tiles.count() / kTilesForEach);
  const uint64_t key = streamKey(options.seed, RandomStream::PixelSamples);
  const auto trial = [&] {
    return secondsOf(tried, [&](size_t k) {
      sampleTile(scene, options.filter, integrator, key, tiles.at(order(k)),
                 {0, kPassSpp, kPassSpp, kMaxPassSpp, 0},
                 static_cast<uint32_t>(options.groups.size()),
                 [](uint32_t, const CameraSample&) {});
    });
  };
  const double firstS = trial(), tilesS = trial(), parts = double(tiles.count()) / double(tried);
  const double learningS = std::max(0.0, firstS - tilesS) * parts / kLearnTogether;
  double allS = tilesS * parts;
  if (integrator.splatPhotons) {
    constexpr uint64_t kChunk = 1024;
    const uint64_t all = uint64_t{kPassSpp} * scene.film.width * scene.film.height,
                   chunks = all / kTilesForEach / kChunk + 1;
    const double photonsS = secondsOf(chunks, [&](size_t k) {
      Splats splats;
      integrator.splatPhotons(k * kChunk, (k + 1) * kChunk, splats);
    });
    allS += photonsS * double(all) / double(chunks * kChunk);
  }
  uint32_t spp = kPassSpp;
  while (spp > 1 && passes * allS * spp / kPassSpp > timeS - learningS) spp /= 2;
  return spp;
}

}  // namespace bnvpl
