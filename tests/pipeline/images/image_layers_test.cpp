// Layers for compositing: coverage, positions, objects, Cryptomatte, and what denoisers take.
#include <bit>
#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/vec3.h"
#include "formats/image/exr_io.h"
#include "scene/load_scene.h"
#include "tests/pipeline/tool_runner.h"
#include "tools/common/process/exit_codes.h"
#include "tools/common/run/run_tool.h"

namespace bnvpl {
namespace {

constexpr const char* kCompositing =
    " --layers A,P,Z,N,objectid,materialid,CryptoObject,CryptoMaterial";

class ImageLayers : public PipelineTest {
 protected:
  // Renders the scene, whose objects and materials are Floor, Wall and Lamp, into i.exr.
  Image render(const std::string& options) const {
    succeed("vpl-render", scene_ + " --integrator path --quiet -o " + path("i.exr") + options);
    return readExr(at("i.exr"));
  }
  // The same scene under a sky, as sky.toml; quoted.
  std::string underSky() const {
    fs::copy(BNVPL_SOURCE "/scenes/test", at("test"));
    write("test/sky.toml", readAll(at("test/one-bounce.toml")) +
                               "\n[[light]]\ntype = \"environment\"\nradiance = [0.5, 1.0, 2.0]\n");
    return path("test/sky.toml");
  }
};

// Ids and coverages of a pixel's ranks.
std::vector<std::pair<uint32_t, float>> ranksOf(const Image& image, const std::string& layer,
                                                size_t pixel) {
  std::vector<std::pair<uint32_t, float>> ranks;
  for (const char* number : {"00", "01", "02"}) {
    for (const auto& [id, coverage] : {std::pair{".R", ".G"}, {".B", ".A"}}) {
      ranks.emplace_back(std::bit_cast<uint32_t>((*image.find(layer + number + id))[pixel]),
                         (*image.find(layer + number + coverage))[pixel]);
    }
  }
  return ranks;
}

// The manifest of a layer: names by ids.
std::map<uint32_t, std::string> manifestOf(const Image& image, const std::string& layer) {
  for (const auto& [key, value] : image.attributes) {
    if (!key.starts_with("cryptomatte/") || !key.ends_with("/name") || value != layer) continue;
    const std::string prefix = key.substr(0, key.size() - 4);
    EXPECT_EQ(prefix.size(), std::string("cryptomatte/1234567/").size());
    EXPECT_EQ(image.attributes.at(prefix + "hash"), "MurmurHash3_32");
    EXPECT_EQ(image.attributes.at(prefix + "conversion"), "uint32_to_float32");
    std::map<uint32_t, std::string> names;
    const Json manifest = Json::parse(image.attributes.at(prefix + "manifest"));
    for (const auto& [name, hex] : manifest.items())
      names[static_cast<uint32_t>(std::stoul(hex.get<std::string>(), nullptr, 16))] = name;
    return names;
  }
  ADD_FAILURE() << "no manifest of " << layer;
  return {};
}

TEST_F(ImageLayers, CryptomatteIsReadBack) {
  const Image image = render(std::string(" --spp 16 --pixels half") + kCompositing);
  const std::vector<float>& coverage = *image.find("A");
  for (const std::string layer : {"CryptoObject", "CryptoMaterial"}) {
    const auto names = manifestOf(image, layer);
    std::set<std::string> all, seen;
    for (const auto& [id, name] : names) all.insert(name);
    for (const char* name : {"Floor", "Wall", "Lamp"}) EXPECT_EQ(all.count(name), 1u) << name;
    size_t edges = 0;
    for (size_t i = 0; i < image.pixelCount(); ++i) {
      const auto ranks = ranksOf(image, layer, i);
      float sum = 0.0f;
      for (size_t r = 0; r < ranks.size(); ++r) {
        const auto [id, share] = ranks[r];
        sum += share;
        EXPECT_EQ(share == 0.0f, id == 0u);
        if (share > 0.0f) {
          ASSERT_EQ(names.count(id), 1u) << layer << i;
          seen.insert(names.at(id));
        }
        if (r == 0) continue;
        EXPECT_LE(share, ranks[r - 1].second);
        if (share > 0.0f && share == ranks[r - 1].second) {
          EXPECT_GT(id, ranks[r - 1].first);
        }
      }
      edges += ranks[1].second > 0.0f;
      EXPECT_NEAR(sum, coverage[i], 1e-3f) << layer << i;  // A is half
      EXPECT_EQ(std::fmod(sum * 16.0f, 1.0f), 0.0f);       // samples of the pixel
    }
    EXPECT_EQ(seen, (std::set<std::string>{"Floor", "Wall", "Lamp"}));
    EXPECT_GT(edges, 10u);
  }
}

TEST_F(ImageLayers, CoverageAndPositionsAreThoseOfTheFirstHits) {
  const Image image = render(std::string(" --spp 16") + kCompositing);
  const auto& m = image.camera->worldToNdc;
  const std::vector<float>& coverage = *image.find("A");
  const Scene scene = loadScene(BNVPL_SOURCE "/scenes/test/one-bounce.toml");
  size_t covered = 0, partly = 0;
  double depth = 0.0, expectedDepth = 0.0;
  const auto valueOf = [&](const std::string& channel, size_t i) {
    return (*image.find(channel))[i];
  };
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    EXPECT_EQ(coverage[i] > 0.0f, std::isfinite((*image.find("Z"))[i]));
    EXPECT_EQ(coverage[i] > 0.0f, (*image.find("objectid"))[i] > 0.0f);
    EXPECT_EQ(coverage[i] > 0.0f, (*image.find("materialid"))[i] > 0.0f);
    partly += coverage[i] > 0.0f && coverage[i] < 1.0f;
    if (coverage[i] < 1.0f) continue;
    ++covered;
    const Vec3 p{(*image.find("P.X"))[i], (*image.find("P.Y"))[i], (*image.find("P.Z"))[i]};
    const auto column = [&](size_t j) {
      return p.x * m[j] + p.y * m[4 + j] + p.z * m[8 + j] + m[12 + j];
    };
    // Positions project to their pixels.
    EXPECT_NEAR(column(0) / column(3) * 64.0f, float(i % 64) + 0.5f, 0.3f);
    EXPECT_NEAR(column(1) / column(3) * 48.0f, float(i / 64) + 0.5f, 0.3f);
    if (ranksOf(image, "CryptoObject", i)[1].second > 0.0f) continue;
    const auto object = static_cast<size_t>(valueOf("objectid", i)) - 1,
               material = static_cast<size_t>(valueOf("materialid", i)) - 1;
    EXPECT_EQ(scene.objectNames.at(object), scene.materials.at(material).name);
    depth += double{valueOf("Z", i)};
    expectedDepth += double{dot(p - scene.camera.position, scene.camera.forward)};
    if (object == 0) {  // the floor
      EXPECT_NEAR(p.y, 0.0f, 1e-5f);
      for (const auto& [axis, value] : {std::pair{"X", 0.0f}, {"Y", 1.0f}, {"Z", 0.0f}})
        EXPECT_NEAR(valueOf(std::string("N.") + axis, i), value, 1e-5f) << axis;
    }
  }
  EXPECT_NEAR(depth, expectedDepth, 0.01 * expectedDepth);
  EXPECT_GT(covered, 500u);
  EXPECT_GT(partly, 20u);
}

// A transparent film differs from the other only by the sky that camera rays see.
TEST_F(ImageLayers, ATransparentFilmLeavesOutTheSky) {
  const std::string sky = underSky();
  succeed("vpl-place", sky + " -o " + path("c.vpl") + " -n 300 --quiet");
  succeed("vpl-eliminate", path("c.vpl") + " -o " + path("v.vpl") + " -n 60 --quiet");
  succeed("vpl-estimate",
          sky + " " + path("v.vpl") + " -o " + path("l.vpl") + " --photons 2k --quiet");
  for (const std::string& method :
       {std::string("--integrator path"), path("l.vpl") + " --fireflies keep",
        path("l.vpl") + " --integrator guided",
        path("l.vpl") + " --only direct --fireflies keep"}) {
    const std::string command = sky + " " + method + " --spp 4 --layers A --quiet -o ";
    succeed("vpl-render", command + path("sky.exr"));
    succeed("vpl-render", command + path("clear.exr") + " --transparent on");
    const Image with = readExr(at("sky.exr")), without = readExr(at("clear.exr"));
    EXPECT_EQ(*with.find("A"), *without.find("A"));
    size_t empty = 0;
    double skyLight = 0.0, left = 0.0, surface = 0.0, clearSurface = 0.0;
    for (size_t i = 0; i < with.pixelCount(); ++i) {
      const float a = (*with.find("A"))[i], b = (*with.find("B"))[i],
                  clear = (*without.find("B"))[i];
      if (a == 0.0f) {
        ++empty;
        skyLight += double{b}, left += double{clear};
      }
      if (a == 1.0f) surface += double{b}, clearSurface += double{clear};
    }
    EXPECT_GT(skyLight, 1.9 * double(empty)) << method;
    // Further rays of direct light may meet geometry where those of the layer do not.
    EXPECT_LT(left, (method.find("path") != std::string::npos ? 1e-9 : 0.05) * skyLight) << method;
    EXPECT_GT(empty, 100u);
    EXPECT_NEAR(clearSurface, surface, 0.02 * surface) << method;
  }
}

TEST_F(ImageLayers, DenoiserFeaturesAreThoseOfTheSurfaces) {
  const Image image = render(" --spp 4 --layers A,objectid,denoise_albedo,denoise_normal,albedo");
  const std::vector<float>& coverage = *image.find("A");
  size_t floor = 0;
  for (size_t i = 0; i < image.pixelCount(); ++i) {
    const float object = (*image.find("objectid"))[i], y = (*image.find("denoise_normal.Y"))[i];
    if (coverage[i] == 0.0f) {
      EXPECT_EQ((*image.find("denoise_albedo.G"))[i], 0.0f);
      EXPECT_EQ(y, 0.0f);
    } else if (coverage[i] == 1.0f && object == 1.0f) {
      EXPECT_NEAR((*image.find("denoise_albedo.G"))[i], (*image.find("albedo.G"))[i], 1e-5f);
      // The floor's normal, and at its edge samples of the wall's.
      EXPECT_GE(y, 0.5f);
      EXPECT_NEAR((*image.find("denoise_normal.X"))[i], 1.0f - y, 1e-5f);
      floor += y == 1.0f;
    }
  }
  EXPECT_GT(floor, 200u);
}

// Path reuse is what makes the noise of neighbours alike.
TEST_F(ImageLayers, ForDenoiserIsWithoutReuseAndAddsItsLayers) {
  makeStages(scene_);
  const std::string command = scene_ + " " + path("lit.vpl") + " --spp 2 --quiet -o ";
  succeed("vpl-render", command + path("default.exr"));
  succeed("vpl-render", command + path("alone.exr") + " --reuse 1");
  succeed("vpl-render", command + path("denoise.exr") + " --for-denoiser on --layers Z");
  const Image image = readExr(at("denoise.exr"));
  EXPECT_EQ(*image.find("R"), *readExr(at("alone.exr")).find("R"));
  EXPECT_NE(*image.find("R"), *readExr(at("default.exr")).find("R"));
  for (const char* name : {"Z", "denoise_albedo.R", "denoise_normal.X"})
    EXPECT_NE(image.find(name), nullptr) << name;
  fail("vpl-render", command + path("x.exr") + " --for-denoiser on --reuse 4", kExitUsage,
       {"--for-denoiser", "--reuse 4", "leave one of them out"});
  fail("vpl-render", command + path("x.exr") + " --for-denoiser on --gather interleaved",
       kExitUsage, {"--for-denoiser", "--gather interleaved", "choose another gather"});
  succeed("vpl-render",
          scene_ + " --integrator path --spp 1 --quiet --for-denoiser on -o " + path("path.exr"));
}

TEST_F(ImageLayers, CountersOfACompensationAreLayersAndStatistics) {
  makeStages(scene_);
  const std::string render = scene_ + " " + path("lit.vpl") + " --spp 1 --size 8x6 --clamp 8 -o " +
                             path("c.exr") + " --layers locallights --gather shirley --compensate ";
  fail("vpl-render", render + "near-field", kExitUsage, {"locallights", "--compensate local"});
  succeed("vpl-render", render + "local --stats " + path("c.json"));
  const Image image = readExr(at("c.exr"));
  double sum = 0.0;
  for (const float v : *image.find("locallights")) sum += double{v};
  EXPECT_GT(sum, 0.0);
  const Json stats = Json::parse(readAll(at("c.json")));
  const auto number = [&](const char* name) { return stats.at(name).get<double>(); };
  EXPECT_NEAR(number("mean_locallights"), sum / 48.0, 1e-3);
  EXPECT_GT(number("restored_over_removed"), 0.0);
  EXPECT_NEAR(number("restored_over_removed"), number("mean_compensated") / number("mean_clamped"),
              1e-6);
}

TEST_F(ImageLayers, MatrixGathersTellTheEntriesTheyEvaluate) {
  makeStages(scene_);
  for (const char* gather :
       {"mrcs --rows 9 --columns 30", "lightslice --slices 9", "matrix-completion --slices 9"}) {
    succeed("vpl-render", scene_ + " " + path("lit.vpl") + " --spp 1 --size 8x6 -o " +
                              path("m.exr") + " --gather " + gather + " --stats " + path("m.json"));
    const Json stats = Json::parse(readAll(at("m.json")));
    const auto number = [&](const char* name) { return stats.at(name).get<double>(); };
    EXPECT_GE(number("matrix_rows"), 6.0) << gather;
    EXPECT_LE(number("matrix_rows"), 24.0) << gather;
    EXPECT_EQ(number("matrix_entries"), number("matrix_rows") * number("emission_points"))
        << gather;
    const std::string name = gather;
    if (name.starts_with("mrcs")) {
      EXPECT_GT(number("split_clusters"), 5.0);
    }
    if (name.starts_with("lightslice")) {
      EXPECT_GT(number("slice_clusters"), 10.0);
    }
  }
}

TEST_F(ImageLayers, IlluminationCutTellsThePairsAndRaysOfItsPlan) {
  makeStages(scene_);
  succeed("vpl-render", scene_ + " " + path("lit.vpl") + " --spp 1 --size 24x18 -o " +
                            path("p.exr") + " --gather illumination-cut --stats " + path("p.json"));
  const Json stats = Json::parse(readAll(at("p.json")));
  EXPECT_GT(stats.at("plan_pairs").get<double>(), 24.0);
  EXPECT_GT(stats.at("plan_rays").get<double>(), 24.0);
}

}  // namespace
}  // namespace bnvpl
