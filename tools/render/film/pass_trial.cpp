#include "tools/render/film/pass_trial.h"

#include "core/parallel.h"
#include "core/random_streams.h"
#include "tools/render/film/partial_film.h"
#include "tools/render/film/passes.h"
#include "tools/render/film/tiles.h"

namespace bnvpl {

namespace {

constexpr size_t kMinTiles = 64, kTilesForEach = 64;    // a trial has one tile of this many
constexpr size_t kWorthATrial = 512;                    // tiles of a film

// Seconds of `count` units that are tried in parallel.
template <typename Unit>
double secondsOf(size_t count, const Unit& unit) {
  const double startS = nowS();
  parallelFor(count, 1, unit);
  return nowS() - startS;
}

}  // namespace

uint32_t sppThatFits(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                     double passS) {
  const Tiles tiles(scene.film);
  if (tiles.count() < kWorthATrial) return kPassSpp;
  const SpreadOrder order(tiles.count());
  const size_t tried = std::max(kMinTiles, tiles.count() / kTilesForEach);
  const uint64_t key = streamKey(options.seed, RandomStream::PixelSamples);
  const double tilesS = secondsOf(tried, [&](size_t k) {
    sampleTile(scene, options.filter, integrator, key, tiles.at(order(k)),
               {0, kPassSpp, kPassSpp, kMaxPassSpp, 0},
               static_cast<uint32_t>(options.groups.size()), [](uint32_t, const CameraSample&) {});
  });
  double allS = tilesS * double(tiles.count()) / double(tried);
  if (integrator.tracePhotons) {
    constexpr uint64_t kChunk = 1024;
    const uint64_t all = uint64_t{kPassSpp} * scene.film.width * scene.film.height,
                   chunks = all / kTilesForEach / kChunk + 1;
    const double photonsS = secondsOf(chunks, [&](size_t k) {
      Splats splats;
      integrator.tracePhotons(k * kChunk, (k + 1) * kChunk, splats);
    });
    allS += photonsS * double(all) / double(chunks * kChunk);
  }
  uint32_t spp = kPassSpp;
  while (spp > 1 && allS * spp / kPassSpp > passS) spp /= 2;
  return spp;
}

}  // namespace bnvpl
