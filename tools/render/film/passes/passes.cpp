#include "tools/render/film/passes/passes.h"

#include <algorithm>
#include <array>

#include "core/random_streams.h"
#include "tools/common/process/clock.h"
#include "tools/render/film/film_groups.h"
#include "tools/render/film/fireflies.h"
#include "tools/render/film/passes/partial_film.h"
#include "tools/render/film/passes/pass_error.h"
#include "tools/render/film/passes/pass_trial.h"
#include "tools/render/film/passes/passes_state.h"

namespace bnvpl {

namespace {

constexpr uint64_t kUniformPasses = 4;  // passes before the error estimate is used
constexpr double kWantedPasses = 10.0;  // within the time, for the error and adaptive passes
constexpr double kFirstPreview = 0.1;   // share of the time before the first preview

class Passes {
 public:
  Passes(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
         const PassBudget& budget)
      : scene_(scene),
        integrator_(integrator),
        options_(options),
        budget_(budget),
        tiles_(scene.film),
        key_(streamKey(options.seed, RandomStream::PixelSamples)),
        state_(size_t{scene.film.width} * scene.film.height, tiles_.count(), options.groups.size()),
        known_(state_.sums.size()) {}

  void run(const ProgressFn& progress, const WorkControls& controls, const FilmPreview& preview) {
    const bool resumed = !controls.state.empty();
    if (resumed) state_.decode(controls.state);
    startS_ = budget_.startS - state_.at.spentS;
    if (state_.at.passSpp == 0)
      state_.at.passSpp = budget_.passSpp ? budget_.passSpp : trialPassSpp();
    if (progress) progress(samplesSoFar() + state_.at.splats.photons);
    PreviewPace pace(std::min(nowS() + 1.0, startS_ + kFirstPreview * budget_.timeS));
    for (bool midPass = resumed; midPass || !ended(); midPass = false) {
      if (!midPass) chooseSpp();
      const double earlierS = state_.at.passesS;
      makePass(progress, controls, preview, pace);
      if (!midPass) lastPassS_ = state_.at.passesS - earlierS;
      closePass();
      if (progress)
        progress.tell({leftS(), state_.at.pass > 1 ? std::optional(error_) : std::nullopt});
      if (preview.image && pace.due()) pace.show([&] { preview.image(imageSoFar()); });
    }
  }

  Image image(FilmStats& stats, PassesDone& done) const {
    Image image = blankImage(scene_.film);
    const Shown shown = this->shown();
    addRadiance(shown.sums, options_.shown, image);
    addGroups(state_.groups, options_.groups, shown.sums.perSample, shown.groups, image);
    for (const Layer* layer : options_.layers) addLayer(*layer, shown.sums, image);
    addFirstHits(tiles_, options_.layers, options_.firstHits, {0, 0, image.width, image.height},
                 image);
    stats = statsOf(shown.sums, samplesSoFar());
    stats.nonFinite += state_.at.splats.nonFinite;
    done = {state_.at.pass, error_, nowS() - startS_, passSpp(), endedBy_};
    return image;
  }

 private:
  uint32_t passSpp() const { return static_cast<uint32_t>(state_.at.passSpp); }
  Image imageSoFar() const {
    const double startS = nowS();
    Image image = blankImage(scene_.film);
    addRadiance(shown().sums, options_.shown, image);
    finishS_ = nowS() - startS;
    return image;
  }
  FilmSums sumsSoFar() const {
    return {state_.sums, state_.counts, 1.0 / double(state_.at.pass), known_, {}, &state_.groups};
  }
  // The sums so far as the image shows them; `sums` refers to the vectors.
  struct Shown {
    std::vector<PixelSums> filtered;
    std::vector<PixelCounts> counts;  // with those of the filter
    std::vector<BothLights> redistributed;
    std::vector<Vec3> groups;  // change of the light groups by the redistribution
    FilmSums sums;
  };
  Shown shown() const {
    Shown out{{}, {}, {}, {}, sumsSoFar()};
    const Film& film = scene_.film;
    if (options_.gatherFilter) {
      out.filtered = state_.sums;
      const PixelBox all{0, 0, static_cast<int>(film.width), static_cast<int>(film.height)};
      out.counts = state_.counts;
      applyFilter(
          options_.gatherFilter, film.width, all, [&](size_t i) { return known_[i].samples; },
          out.filtered, out.counts);
      out.sums.sums = out.filtered;
      out.sums.counts = out.counts;
    }
    if (options_.redistributeFireflies)
      out.sums.redistributed = out.redistributed =
          redistributeFireflies(out.sums, options_.shown, film.width, &out.groups);
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
    if (spentS + passS() + finishS() > budget_.timeS) endedBy_ = "time";
    if (passes >= kUniformPasses && budget_.error > 0.0 && error_ <= budget_.error)
      endedBy_ = "error";
    if (passes >= maxPasses()) endedBy_ = "passes";
    return !endedBy_.empty();
  }
  uint32_t trialPassSpp() const {
    const double leftS = budget_.timeS - (nowS() - startS_);
    if (!std::isfinite(leftS)) return kPassSpp;
    return sppThatFits(scene_, integrator_, options_, leftS, kWantedPasses);
  }
  uint64_t maxPasses() const { return std::min(budget_.passes, budget_.spp / passSpp()); }
  // Expected time of a pass, after one: that of the last, as tiles learn the lights in the first.
  double passS() const {
    return lastPassS_ > 0.0 ? lastPassS_ : state_.at.passesS / double(state_.at.pass);
  }
  // Time that the image takes once the passes are made: twice that of an image to look at, as it
  // has other layers and is written.
  double finishS() const {
    if (std::isfinite(budget_.timeS) && finishS_ == 0.0) imageSoFar();
    return 2.0 * finishS_;
  }
  // Seconds until the first limit of the budget is reached, as far as is known.
  std::optional<double> leftS() const {
    double left = budget_.timeS - (nowS() - startS_);
    if (const uint64_t most = maxPasses(); most < UINT64_MAX / 2 / passSpp())
      left = std::min(left, double(most - std::min(most, state_.at.pass)) * passS());
    // The error falls with the root of the number of passes.
    if (budget_.error > 0.0 && state_.at.pass >= kUniformPasses) {
      const double times = std::pow(error_ / budget_.error, 2) - 1.0;
      left = std::min(left, std::max(0.0, times) * double(state_.at.pass) * passS());
    }
    return std::isfinite(left) ? std::optional(left) : std::nullopt;
  }

  void chooseSpp() {
    const uint64_t passes = state_.at.pass;
    std::fill(state_.done.begin(), state_.done.end(), 0);
    if (passes < kUniformPasses || !budget_.adaptive || integrator_.splatPhotons) {
      std::fill(state_.spp.begin(), state_.spp.end(), passSpp());
    } else {
      state_.spp = allocateSamples(tiles_, variances_, state_.inverse, passes, passSpp(),
                                   random64(key_, passes, kDrawSpp));
    }
  }

  void makePass(const ProgressFn& progress, const WorkControls& controls,
                const FilmPreview& preview, PreviewPace& pace) {
    const double passesStartS = nowS() - state_.at.passesS;
    const auto state = [&] {
      state_.at.spentS = nowS() - startS_;
      state_.at.passesS = nowS() - passesStartS;
      return state_.encode();
    };
    // Photons come after the tiles, whose light alone would mislead.
    const bool showTiles = state_.at.pass == 0 && !integrator_.splatPhotons;
    std::optional<PartialFilm> partial;
    if (showTiles && preview.image) partial.emplace(scene_.film);
    std::mutex showing;
    const auto show = [&](size_t index) {
      if (!showTiles || (!preview.tile && !preview.image)) return;
      const Tile tile = tiles_.at(index);
      const std::vector<Vec3> radiance =
          meanRadiance(tiles_, tile, state_.sums, options_.shown, 1.0);
      if (preview.tile) preview.tile(boxOf(tile), radiance);
      if (!partial) return;
      partial->add(index, radiance);
      const std::unique_lock lock(showing, std::try_to_lock);
      if (lock.owns_lock() && pace.due()) pace.show([&] { preview.image(partial->image()); });
    };
    forUnitsLeft(
        state_.done, controls,
        [&](size_t index) {
          makeTile(index);
          show(index);
          if (progress) progress(uint64_t{tiles_.at(index).pixels()} * state_.spp[index]);
        },
        state, SpreadOrder(tiles_.count()));
    if (integrator_.splatPhotons) addPhotons(progress, controls, state);
    state_.at.passesS = nowS() - passesStartS;
  }

  template <typename State>
  void addPhotons(const ProgressFn& progress, const WorkControls& controls, const State& state) {
    const float share = 1.0f / static_cast<float>(passSpp());
    addSplats(
        integrator_.splatPhotons, (state_.at.pass + 1) * passSpp() * state_.sums.size(),
        state_.at.splats,
        [&](const Splat& splat) {
          addSplat(splat, share, state_.sums, state_.counts);
          if (!isFinite(splat.radiance) || options_.shown == ShownLight::Direct) return;
          const Vec3 contribution = splat.radiance * share;
          state_.groups.add(splat, share);
          for (size_t c = 0; c < 3; ++c)
            state_.values[splat.pixel][c] += double{contribution[int(c)]};
        },
        progress, controls, state);
  }

  void makeTile(size_t index) {
    const Tile tile = tiles_.at(index);
    const uint32_t spp = state_.spp[index];
    const uint64_t key = random64(key_, state_.at.pass, kDrawPass);
    const auto sequenceOffset = static_cast<uint32_t>(random64(key, 0, kDrawOffset) >> 33);
    std::vector<PixelSums> sums(tile.pixels());
    sampleTile(scene_, options_.filter, integrator_, key, tile,
               {0, spp, spp, kMaxPassSpp, sequenceOffset}, state_.groups.count,
               [&](uint32_t p, const CameraSample& sample) {
                 const size_t i = tiles_.pixelIndex(tile, p);
                 if (addSample(sample.radiance, sums[p], state_.counts[i]))
                   state_.groups.add(i, sample, options_.shown, 1.0f / static_cast<float>(spp));
               });
    for (uint32_t p = 0; p < tile.pixels(); ++p) {
      const size_t i = tiles_.pixelIndex(tile, p);
      for (double& sum : sums[p].sum) sum /= spp;
      for (size_t kind = 0; kind < 2; ++kind) {
        for (const Vec3 contribution : sums[p].brightest[kind])
          state_.sums[i].keepBrightest(kind, contribution * (1.0f / static_cast<float>(spp)));
      }
      for (size_t k = 0; k < sums[p].sum.size(); ++k) state_.sums[i].sum[k] += sums[p].sum[k];
      for (size_t c = 0; c < 3; ++c)
        state_.values[i][c] = shownRadiance(sums[p], options_.shown, c);
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
          const double mean = shownRadiance(state_.sums[i], options_.shown, c) / passes;
          const double spread = std::max(0.0, state_.squares[i][c] / passes - mean * mean);
          known_[i].variance[c] = state_.at.pass > 1 ? spread / (passes - 1.0) : 0.0;
        }
      }
    });
    variances_ = relativeVariances(sumsSoFar(), options_.shown, scene_.film.width);
    error_ = relativeError(variances_);
  }

  enum Draw : uint32_t { kDrawPass, kDrawSpp, kDrawOffset };

  const Scene& scene_;
  const Integrator& integrator_;
  const FilmOptions& options_;
  const PassBudget& budget_;
  Tiles tiles_;
  uint64_t key_;
  PassesState state_;
  std::vector<PixelPasses> known_;  // finished passes
  std::vector<double> variances_;   // relative
  double error_ = 0.0, startS_ = 0.0;
  double lastPassS_ = 0.0;  // 0: not known
  mutable double finishS_ = 0.0;
  std::string_view endedBy_;
};

}  // namespace

Image renderPasses(const Scene& scene, const Integrator& integrator, const FilmOptions& options,
                   const PassBudget& budget, FilmStats& stats, PassesDone& done,
                   const ProgressFn& progress, const WorkControls& controls,
                   const FilmPreview& preview) {
  Passes passes(scene, integrator, options, budget);
  passes.run(progress, controls, preview);
  return passes.image(stats, done);
}

}  // namespace bnvpl
