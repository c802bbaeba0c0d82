// Hashes and ranks of Cryptomatte; tests/pipeline/images/image_layers_test.cpp reads images back.
#include "tools/render/film/features/cryptomatte.h"

#include <gtest/gtest.h>

namespace bnvpl {
namespace {

// From the specification and its sample images; the others from the reference implementation.
TEST(Cryptomatte, HashesAreThoseOfTheSpecification) {
  EXPECT_EQ(murmurHash3("bunny"), 0x13851a76u);
  EXPECT_EQ(murmurHash3("default"), 0x42c9679fu);
  EXPECT_EQ(murmurHash3("bunny_porcelain_mat"), 0xb24b26d4u);
  EXPECT_EQ(murmurHash3(""), 0u);
}

TEST(Cryptomatte, IdsAreNormalFloats) {
  for (int i = 0; i < 20000; ++i) {
    const std::string name = "object " + std::to_string(i);
    const uint32_t id = cryptomatteId(name), exponent = id >> 23 & 255;
    EXPECT_GE(exponent, 1u);
    EXPECT_LE(exponent, 254u);
    EXPECT_EQ(id & 0x807fffffu, murmurHash3(name) & 0x807fffffu);
  }
  EXPECT_EQ(cryptomatteId(""), 1u << 23);
}

TEST(Cryptomatte, RanksGoByCoverageThenHash) {
  std::vector<uint32_t> ids{7, 9, 7, 3, 9, 8};
  const std::vector<MatteRank> ranks = rankMattes(ids, 8);
  ASSERT_EQ(ranks.size(), 4u);
  const std::vector<std::pair<uint32_t, float>> expected{
      {7, 0.25f}, {9, 0.25f}, {3, 0.125f}, {8, 0.125f}};
  for (size_t i = 0; i < 4; ++i) EXPECT_EQ(std::pair(ranks[i].id, ranks[i].coverage), expected[i]);
}

TEST(Cryptomatte, ManifestsNameEachIdOnce) {
  std::map<std::string, std::string> attributes;
  const std::vector<std::string> names{"bunny", "default", "bunny", "a \"b\""};
  addMatteAttributes("CryptoObject", names, attributes);
  ASSERT_EQ(attributes.size(), 4u);
  char key[16];
  std::snprintf(key, sizeof key, "%08x", murmurHash3("CryptoObject"));
  const std::string prefix = "cryptomatte/" + std::string(key, 7) + "/";
  EXPECT_EQ(attributes.at(prefix + "name"), "CryptoObject");
  EXPECT_TRUE(
      attributes.at(prefix + "manifest")
          .starts_with("{\"bunny\":\"13851a76\",\"default\":\"42c9679f\",\"a \\\"b\\\"\":\""));
}

TEST(Cryptomatte, NamesAreUtf8) {
  Scene scene;
  scene.objectNames = {"caf\xc3\xa9", "caf\xe9", ""};
  EXPECT_EQ(objectMatteNames(scene),
            (std::vector<std::string>{"caf\xc3\xa9", "caf\xef\xbf\xbd", "default"}));
}

}  // namespace
}  // namespace bnvpl
