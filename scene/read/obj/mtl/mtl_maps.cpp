#include "scene/read/obj/mtl/mtl_maps.h"

#include <algorithm>

#include "core/files.h"

namespace bnvpl {

TextureUse MtlMaps::describe(const std::string& field,
                             const tinyobj::texture_option_t& options) const {
  std::string name = field;
  std::replace(name.begin(), name.end(), '\\', '/');
  TextureUse use;
  use.file = (from_.library.parent_path() / name).lexically_normal();
  if (!isRegularFile(use.file)) {
    const fs::path other = (from_.obj.parent_path() / name).lexically_normal();
    if (isRegularFile(other)) use.file = other;
  }
  const Vec3 scale = fromOrigin({options.scale[0], options.scale[1], options.scale[2]}, {});
  const Vec3 offset = fromOrigin(
      {options.origin_offset[0], options.origin_offset[1], options.origin_offset[2]}, {});
  use.scale = {scale.x, scale.y};
  use.offset = {offset.x, offset.y};
  return use;
}

uint32_t MtlMaps::add(const std::string& field, const tinyobj::texture_option_t& options, bool srgb,
                      bool mask, const char* otherwise) const {
  if (field.empty()) return kNone;
  TextureUse use = describe(field, options);
  use.srgb = srgb;
  use.mask = mask;
  if (!expectOnly_) return builder_.addTexture(use, {otherwise, where_});
  builder_.expectTexture(use);
  return kNone;
}

}  // namespace bnvpl
