#include "tools/render/film/passes.h"

#include <algorithm>
#include <array>

#include "tools/common/files/streams.h"
#include "tools/common/run/clock.h"
#include "tools/render/film/film_groups.h"
#include "tools/render/film/fireflies.h"
#include "tools/render/film/pass_error.h"
#include "tools/render/splat/add_splats.h"

namespace bnvpl {

namespace {

constexpr uint64_t kUniformPasses = 4;  // passes before the error estimate is used
constexpr double kPreviewEveryS = 5.0;

using Rgb = std::array<double, 3>;

// What is known so far; all of it goes into a checkpoint, which is always in the middle of a pass.
struct PassesState {
  struct Progress {
    uint64_t pass = 0;  // index of the current pass
    double spentS = 0.0;
    SplatProgress splats;
  };
  PassesState(size_t pixels, size_t tiles, size_t lightGroups)
      : done(tiles),
        spp(tiles),
        samples(tiles),
        inverse(tiles),
        sums(pixels),
        counts(pixels),
        values(pixels),
        squares(pixels),
        groups(pixels, static_cast<uint32_t>(lightGroups)) {}

  Progress at;
  std::vector<uint8_t> done;        // tiles of the current pass
  std::vector<uint32_t> spp;        // samples per pixel of each tile in the current pass
  std::vector<uint64_t> samples;    // samples per pixel of each tile in the finished passes
  std::vector<double> inverse;      // sum over finished passes of 1 / spp
  std::vector<PixelSums> sums;      // sums of the passes' means
  std::vector<PixelCounts> counts;  // sums over samples
  std::vector<Rgb> values;          // shown R, G, B of the current pass
  std::vector<Rgb> squares;         // sums over finished passes of squared `values`
  FilmGroups groups;                // sums of the passes' means

  template <typename Fn>
  void forArrays(const Fn& fn) {
    fn(done), fn(spp), fn(samples), fn(inverse), fn(sums), fn(counts), fn(values), fn(squares);
    groups.forArrays([&](auto, auto& array, size_t) { fn(array); });
  }
  std::string encode() {
    std::string bytes;
    appendArray(bytes, std::array{at});
    forArrays([&](const auto& array) { appendArray(bytes, array); });
    return bytes;
  }
  void decode(std::string_view bytes) {
    std::array<Progress, 1> progress{};
    takeArray(bytes, progress);
    at = progress[0];
    forArrays([&](auto& array) { takeArray(bytes, array); });
    requireAllTaken(bytes);
  }
};

class Passes {
 public:
  Passes(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
         const Budget& budget)
      : scene_(scene),
        integrator_(integrator),
        options_(options),
        budget_(budget),
        tiles_(scene.film),
        key_(streamKey(options.seed, Stream::PixelSamples)),
        state_(size_t{scene.film.width} * scene.film.height, tiles_.count(), options.groups.size()),
        known_(state_.sums.size()) {}

  void run(const ProgressFn& progress, const Resume& resume, const PreviewFn& preview) {
    const bool resumed = !resume.state.empty();
    if (resumed) state_.decode(resume.state);
    startS_ = nowS() - state_.at.spentS;
    if (progress) progress(samplesSoFar() + state_.at.splats.photons);
    double previewS = nowS() + kPreviewEveryS;
    for (bool under = resumed; under || !ended(); under = false) {
      if (!under) chooseSlots();
      makePass(progress, resume);
      closePass();
      if (preview && nowS() >= previewS) {
        Image image = blank();
        addRadiance(shown().sums, options_.only, image);
        preview(image);
        previewS = nowS() + kPreviewEveryS;
      }
    }
  }

  Image image(FilmStats& stats, PassesDone& done) const {
    Image image = blank();
    const Shown shown = this->shown();
    addRadiance(shown.sums, options_.only, image);
    addGroups(state_.groups, options_.groups, shown.sums.perSample, shown.groups, image);
    for (const Layer* layer : options_.layers) addLayer(*layer, shown.sums, image);
    addFirstHits(tiles_, options_.layers, options_.firstHits, {0, 0, image.width, image.height},
                 image);
    stats = statsOf(shown.sums, samplesSoFar());
    stats.filterPixels = shown.filterPixels;
    stats.nonFinite += state_.at.splats.nonFinite;
    done = {state_.at.pass, error_, nowS() - startS_, endedBy_};
    return image;
  }

 private:
  Image blank() const {
    Image image;
    image.width = static_cast<int>(scene_.film.width);
    image.height = static_cast<int>(scene_.film.height);
    return image;
  }
  FilmSums sumsSoFar() const {
    return {state_.sums, state_.counts, 1.0 / double(state_.at.pass), known_, {}, &state_.groups};
  }
  // The sums so far as the image shows them; `sums` refers to the vectors.
  struct Shown {
    std::vector<PixelSums> filtered;
    double filterPixels = 0.0;
    std::vector<BothLights> redistributed;
    std::vector<Vec3> groups;  // change of the light groups by the redistribution
    FilmSums sums;
  };
  Shown shown() const {
    Shown out{{}, 0.0, {}, {}, sumsSoFar()};
    const Film& film = scene_.film;
    if (options_.gatherFilter) {
      out.filtered = state_.sums;
      const PixelBox all{0, 0, static_cast<int>(film.width), static_cast<int>(film.height)};
      out.filterPixels = applyFilter(options_.gatherFilter, film.width, all, out.filtered);
      out.sums.sums = out.filtered;
    }
    if (options_.redistributeFireflies)
      out.sums.redistributed = out.redistributed =
          redistributeFireflies(out.sums, options_.only, film.width, &out.groups);
    return out;
  }
  // Samples of the finished passes, and of the finished tiles of the current one.
  uint64_t samplesSoFar() const {
    uint64_t sum = 0;
    for (size_t t = 0; t < tiles_.count(); ++t) {
      const uint64_t now = state_.done[t] ? state_.spp[t] : 0;
      sum += (state_.samples[t] + now) * tiles_.at(t).pixels();
    }
    return sum;
  }

  bool ended() {
    const uint64_t passes = state_.at.pass;
    if (passes < kMinPasses) return false;
    const double spentS = nowS() - startS_;
    if (spentS + spentS / double(passes) > budget_.timeS) endedBy_ = "time";
    if (passes >= kUniformPasses && budget_.error > 0.0 && error_ <= budget_.error)
      endedBy_ = "error";
    if (passes >= budget_.passes) endedBy_ = "passes";
    return !endedBy_.empty();
  }

  void chooseSlots() {
    const uint64_t passes = state_.at.pass;
    std::fill(state_.done.begin(), state_.done.end(), 0);
    if (passes < kUniformPasses || !budget_.adaptive || integrator_.tracePhotons) {
      std::fill(state_.spp.begin(), state_.spp.end(), kPassSpp);
    } else {
      state_.spp = allocateSamples(tiles_, variances_, state_.inverse, passes, kPassSpp,
                                   random64(key_, passes, kDrawSpp));
    }
  }

  void makePass(const ProgressFn& progress, const Resume& resume) {
    const auto state = [&] {
      state_.at.spentS = nowS() - startS_;
      return state_.encode();
    };
    forUnitsLeft(
        state_.done, resume,
        [&](size_t index) {
          makeTile(index);
          if (progress) progress(uint64_t{tiles_.at(index).pixels()} * state_.spp[index]);
        },
        state);
    if (!integrator_.tracePhotons) return;
    constexpr float kShare = 1.0f / kPassSpp;
    addSplats(
        integrator_.tracePhotons, (state_.at.pass + 1) * kPassSpp * state_.sums.size(),
        state_.at.splats,
        [&](const Splat& splat) {
          addSplat(splat, kShare, state_.sums, state_.counts);
          if (!isFinite(splat.radiance) || options_.only == Only::Direct) return;
          const Vec3 contribution = splat.radiance * kShare;
          state_.groups.add(splat, kShare);
          for (size_t c = 0; c < 3; ++c)
            state_.values[splat.pixel][c] += double{contribution[int(c)]};
        },
        progress, resume, state);
  }

  void makeTile(size_t index) {
    const Tile tile = tiles_.at(index);
    const uint32_t spp = state_.spp[index];
    const uint64_t key = random64(key_, state_.at.pass, kDrawPass);
    const auto sequenceOffset = static_cast<uint32_t>(random64(key, index, kDrawOffset) >> 33);
    std::vector<PixelSums> sums(tile.pixels());
    sampleTile(scene_, options_.filter, integrator_, key, tile,
               {0, spp, spp, kMaxPassSpp, sequenceOffset}, state_.groups.count,
               [&](uint32_t p, const CameraSample& sample) {
                 const size_t i = tiles_.pixelIndex(tile, p);
                 if (addSample(sample.radiance, sums[p], state_.counts[i]))
                   state_.groups.add(i, sample, options_.only, 1.0f / static_cast<float>(spp));
               });
    for (uint32_t p = 0; p < tile.pixels(); ++p) {
      const size_t i = tiles_.pixelIndex(tile, p);
      for (double& sum : sums[p].sum) sum /= spp;
      for (size_t kind = 0; kind < 2; ++kind) {
        for (const Vec3 contribution : sums[p].brightest[kind])
          state_.sums[i].keepBrightest(kind, contribution * (1.0f / static_cast<float>(spp)));
      }
      for (size_t k = 0; k < sums[p].sum.size(); ++k) state_.sums[i].sum[k] += sums[p].sum[k];
      for (size_t c = 0; c < 3; ++c) state_.values[i][c] = shownRadiance(sums[p], options_.only, c);
    }
  }

  void closePass() {
    ++state_.at.pass;
    for (size_t t = 0; t < tiles_.count(); ++t) {
      state_.samples[t] += state_.spp[t];
      state_.inverse[t] += 1.0 / state_.spp[t];
    }
    std::fill(state_.done.begin(), state_.done.end(), 0);
    const double passes = double(state_.at.pass);
    parallelFor(tiles_.count(), 16, [&](size_t t) {
      const Tile tile = tiles_.at(t);
      for (uint32_t p = 0; p < tile.pixels(); ++p) {
        const size_t i = tiles_.pixelIndex(tile, p);
        known_[i].samples = state_.samples[t];
        for (size_t c = 0; c < 3; ++c) {
          const double value = state_.values[i][c];
          state_.squares[i][c] += value * value;
          const double mean = shownRadiance(state_.sums[i], options_.only, c) / passes;
          const double spread = std::max(0.0, state_.squares[i][c] / passes - mean * mean);
          known_[i].variance[c] = state_.at.pass > 1 ? spread / (passes - 1.0) : 0.0;
        }
      }
    });
    variances_ = relativeVariances(sumsSoFar(), options_.only, scene_.film.width);
    error_ = relativeError(variances_);
  }

  // Limit of samples per pixel in a pass.
  static constexpr uint64_t kMaxPassSpp = uint64_t{1} << 20;
  enum Draw : uint32_t { kDrawPass, kDrawSpp, kDrawOffset };

  const Scene& scene_;
  const Integrator& integrator_;
  const FilmOptions& options_;
  const Budget& budget_;
  Tiles tiles_;
  uint64_t key_;
  PassesState state_;
  std::vector<PixelPasses> known_;  // finished passes
  std::vector<double> variances_;   // relative
  double error_ = 0.0, startS_ = 0.0;
  std::string_view endedBy_;
};

}  // namespace

Image renderPasses(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                   const Budget& budget, FilmStats& stats, PassesDone& done,
                   const ProgressFn& progress, const Resume& resume, const PreviewFn& preview) {
  Passes passes(scene, integrator, options, budget);
  passes.run(progress, resume, preview);
  return passes.image(stats, done);
}

}  // namespace bnvpl
