#include "tools/inspect/info/info.h"

#include "tests/inspect/inspect_files.h"
#include "tools/common/run/build_id.h"
#include "tools/inspect/info/spacing.h"

namespace bnvpl {
namespace {

class Info : public InspectTest {};

const Json& columnOf(const Json& info, const std::string& name) {
  for (const Json& c : info["columns"]) {
    if (c["name"] == name) return c;
  }
  throw std::runtime_error("no column " + name);
}

TEST_F(Info, DescribesALitFile) {
  writeVpl(at("lit.vpl"), threeRows(VplStage::Lit));
  const Json info = describeFile(at("lit.vpl"));
  EXPECT_EQ(info["stage"], "lit");
  EXPECT_EQ(info["rows"], 3);
  EXPECT_EQ(info["r_max"], 0.5);
  EXPECT_EQ(info["provenance"][0]["tool"], "vpl-place");
  EXPECT_EQ(columnOf(info, "position.x")["max"], 4.0);
  EXPECT_DOUBLE_EQ(columnOf(info, "position.x")["mean"].get<double>(), 5.0 / 3.0);
  EXPECT_EQ(columnOf(info, "photons")["max"], 4294967297.0);
  EXPECT_EQ(info["energy_W"]["R"], 1.5);
  EXPECT_EQ(info["energy_W"]["mean"], 2.5);

  const std::string text = infoText(info);
  EXPECT_TRUE(
      contains(text, "vpl-place " + buildId() + ": count 3, seed 1; from scene 0000000000001234"))
      << text;
  EXPECT_TRUE(contains(text, "flux.b")) << text;
  EXPECT_TRUE(contains(text, "mean 2.5 W")) << text;
  EXPECT_TRUE(contains(text, "relative_error")) << text;
}

// Such texts come from images of other programs and from file names.
TEST_F(Info, NamesThatAreNoUtf8OrHoldLineBreaksAreNames) {
  const fs::path file = at("i\xff\n.exr");
  Image image = flatImage(2, 2, 0.5f, 0.5f, 0.5f);
  image.attributes["by\n\xfe"] = "a\x1b\nb\xfd";
  image.channels[0].name = std::string(300, 'c') + "\xfc\n";
  Json info = describeImage(image);
  info["file"] = file.string();
  info["bytes"] = 7;
  const Json read = Json::parse(jsonText(info));
  EXPECT_TRUE(read["file"].get<std::string>().ends_with("i\uFFFD\n.exr"));
  EXPECT_EQ(read["attributes"]["by\n\uFFFD"], "a\x1b\nb\uFFFD");
  const std::string text = infoText(info);
  EXPECT_TRUE(contains(text, "i\\xff\\n.exr: OpenEXR, 2 x 2 pixels, 7 bytes\n")) << text;
  EXPECT_TRUE(contains(text, "\n  by\\n\\xfe = a\\x1b\\nb\\xfd\n")) << text;
  EXPECT_TRUE(contains(text, "\n  " + std::string(300, 'c') + "\\xfc\\n ")) << text;
}

TEST_F(Info, PutsTheEmissionPointsOfARowTogether) {
  VplTable table = threeRows(VplStage::Lit);
  table.emitPoints = 2;
  table.emitPosition = {{0, 0, 0}, {0, 2, 0}, {1, 0, 0}, {1, 0, 0}, {4, 0, 0}, {5, 0, 0}};
  table.emitNormal.assign(6, {0, 0, 1});
  writeVpl(at("lit.vpl"), table);
  const Json info = describeFile(at("lit.vpl"));
  EXPECT_EQ(columnOf(info, "emit_position.x")["max"], 5.0);
  EXPECT_EQ(columnOf(info, "emit_position.y")["max"], 2.0);
  EXPECT_EQ(columnOf(info, "emit_normal.z")["min"], 1.0);
}

TEST_F(Info, ListsTheColumnsOfMethods) {
  VplTable table = threeRows(VplStage::Eliminated);
  table.extras = {{"rich.lobes", "W", 2, std::vector<float>{0, 1, 2, 3, 4, 5}},
                  {"rich.basis", "1", 6, std::vector<uint32_t>(18, 7)},
                  {"ward.order", "-", 1, std::vector<uint64_t>{3, 4, 5}}};
  writeVpl(at("v.vpl"), table);
  const Json info = describeFile(at("v.vpl"));
  EXPECT_EQ(columnOf(info, "rich.lobes.1")["mean"], 3.0);
  EXPECT_EQ(columnOf(info, "rich.lobes.1")["unit"], "W");
  EXPECT_EQ(columnOf(info, "rich.basis[6]")["max"], 7.0);
  EXPECT_EQ(info["method_columns"][1]["components"], 6);
  EXPECT_TRUE(contains(infoText(info),
                       "\ncolumns of methods, which all stages keep: rich.lobes (f32 x 2), "
                       "rich.basis (u32 x 6), ward.order (u64)\n"));
  table.extras.clear();
  writeVpl(at("v.vpl"), table);
  EXPECT_FALSE(contains(infoText(describeFile(at("v.vpl"))), "methods"));
}

TEST_F(Info, EmptyFile) {
  VplTable table;
  writeVpl(at("empty.vpl"), table);
  const Json info = describeFile(at("empty.vpl"));
  EXPECT_EQ(info["rows"], 0);
  EXPECT_EQ(columnOf(info, "id")["min"], nullptr);
  EXPECT_TRUE(contains(infoText(info), "no record"));
}

TEST_F(Info, DescribesAnImage) {
  Image image = flatImage(2, 2, 1, 2, 3);
  image.add("Z") = {1, 3, INFINITY, 2};
  image.attributes["bnvpl.provenance"] =
      extendProvenance("", stageRecord("vpl-render", {{"spp", 4}}, Json::object()));
  image.attributes["bnvpl.samplesPerPixel"] = "4";
  writeExr(at("a.exr"), image, ExrPixelType::Float);
  const Json info = describeFile(at("a.exr"));
  EXPECT_EQ(info["width"], 2);
  EXPECT_EQ(columnOf(info, "G")["mean"], 2.0);
  EXPECT_EQ(columnOf(info, "Z")["mean"], 2.0);
  EXPECT_EQ(columnOf(info, "Z")["not_finite"], 1);
  const std::string text = infoText(info);
  EXPECT_TRUE(contains(text, "bnvpl.samplesPerPixel = 4")) << text;
  EXPECT_TRUE(contains(text, "vpl-render " + buildId() + ": spp 4")) << text;
  EXPECT_TRUE(contains(text, "1 not finite")) << text;
}

// Outside of its window a crop holds no values, and zeros in memory.
TEST_F(Info, TheFiguresOfACropAreThoseOfItsWindow) {
  Image crop = flatImage(4, 3, 0, 0, 0);
  crop.dataWindow = PixelBox{1, 1, 3, 2};
  for (ImageChannel& channel : crop.channels) channel.data[5] = 2.0f, channel.data[6] = 4.0f;
  writeExr(at("crop.exr"), crop, ExrPixelType::Float);
  const Json info = describeFile(at("crop.exr"));
  EXPECT_EQ(columnOf(info, "G")["min"], 2.0);
  EXPECT_EQ(columnOf(info, "G")["mean"], 3.0);
  EXPECT_TRUE(contains(infoText(info), "a crop: columns 1 to 2, rows 1 to 1")) << infoText(info);
}

TEST_F(Info, RefusesWhatIsNeither) {
  writeAll(at("a.txt"), "text");
  writeAll(at("a.vpl"), "text");
  writeAll(at("a.exr"), "text");
  EXPECT_TRUE(contains(messageOf<InputError>([&] { describeFile(at("a.txt")); }), "neither"));
  EXPECT_THROW(describeFile(at("a.vpl")), InputError);
  EXPECT_THROW(describeFile(at("a.exr")), InputError);
  EXPECT_THROW(describeFile(at("absent.vpl")), InputError);
  EXPECT_THROW(describeFile(at("")), InputError);  // a folder
}

TEST(Spacing, DistancesByHand) {
  const Spacing s = measureSpacing(threeRows(VplStage::Eliminated));
  EXPECT_EQ(s.measured, 3u);
  EXPECT_DOUBLE_EQ(s.minDistance, 1.0);
  EXPECT_DOUBLE_EQ(s.meanDistance, 5.0 / 3.0);  // distances 1, 1, 3
  EXPECT_DOUBLE_EQ(s.minRelative, 1.0);
  EXPECT_DOUBLE_EQ(s.meanRelative, 5.0 / 3.0);
  EXPECT_FLOAT_EQ(float(s.minOwn), 1.0f / 1.5f);  // 1 / (0.5 + 1)
  EXPECT_FLOAT_EQ(float(s.meanOwn), (1.0f / 1.5f + 1.0f / 1.5f + 1.0f) / 3.0f);
}

TEST(Spacing, TheOtherSideOfAWallIsNoNeighbour) {
  VplTable table = threeRows(VplStage::Eliminated);
  table.normal[1] = {0, 0, -1};
  const Spacing s = measureSpacing(table);
  EXPECT_EQ(s.measured, 2u);
  EXPECT_EQ(s.alone, 1u);
  EXPECT_DOUBLE_EQ(s.minDistance, 4.0);
  table.normal[0] = {1, 0, 0};
  EXPECT_EQ(measureSpacing(table).measured, 0u);
}

// The neighbour lies behind many points of the other side, so the first query does not find it.
TEST(Spacing, LooksFurtherThanTheFirstNeighbours) {
  VplTable table;
  for (int i = 0; i < 100; ++i) {
    table.position.push_back({0.01f * static_cast<float>(i), 0, 0});
    table.normal.push_back(i == 0 || i == 99 ? Vec3{0, 0, 1} : Vec3{0, 0, -1});
  }
  table.albedo.resize(100);
  table.id.resize(100);
  const Spacing s = measureSpacing(table);
  EXPECT_EQ(s.alone, 0u);
  EXPECT_NEAR(s.meanDistance, (2 * 0.99 + 98 * 0.01) / 100, 1e-6);
}

}  // namespace
}  // namespace bnvpl
