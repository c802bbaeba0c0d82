#define TINYGLTF_IMPLEMENTATION  // compiles tinygltf here alone
#include "scene/read/gltf/document/gltf_model.h"

#include <cmath>
#include <limits>

#include "core/files.h"
#include "core/read_file.h"
#include "scene/read/gltf/document/extensions.h"
#include "scene/read/gltf/document/gltf_rules.h"
#include "scene/read/gltf/document/meshopt_view.h"

namespace bnvpl {

namespace {

using Json = nlohmann::json;

bool isDataUri(const std::string& uri) { return uri.starts_with("data:"); }

// Decodes a percent-encoded relative reference (RFC 3986).
std::string decodedUri(const std::string& uri) {
  const auto digit = [](char c) {
    return c >= '0' && c <= '9'   ? c - '0'
           : c >= 'a' && c <= 'f' ? c - 'a' + 10
           : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                  : -1;
  };
  std::string out;
  for (size_t i = 0; i < uri.size(); ++i) {
    if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 && digit(uri[i + 2]) >= 0) {
      out += static_cast<char>(16 * digit(uri[i + 1]) + digit(uri[i + 2]));
      i += 2;
    } else {
      out += uri[i];
    }
  }
  return out;
}

std::string decodeData(const fs::path& file, const std::string& pointer, const std::string& uri) {
  std::vector<unsigned char> bytes;
  std::string type;
  if (!tinygltf::DecodeDataURI(&bytes, type, uri, 0, false)) {
    throw GltfError(file, pointer,
                    std::string("is no base64 data of a type that glTF allows") + kExportAgain);
  }
  return {bytes.begin(), bytes.end()};
}

// The bytes of an image, whatever the type: one that is not read may stand beside one that is.
std::string decodeImage(const fs::path& file, const std::string& pointer, const std::string& uri) {
  const size_t data = uri.find(";base64,");
  const std::string type = "data:application/octet-stream";
  return decodeData(file, pointer, data == uri.npos ? uri : type + uri.substr(data));
}

// The object of an extension of `part`, or null.
const Json* extensionOf(const Json& part, const char* name) {
  const auto extensions = part.find("extensions");
  if (extensions == part.end() || !extensions->is_object()) return nullptr;
  const auto it = extensions->find(name);
  return it != extensions->end() && it->is_object() ? &*it : nullptr;
}

// Also converts large integers in extensions to reals: tinygltf would keep 32 bits of them.
void eraseExtras(Json& json, bool inExtension = false) {
  if (json.is_object()) json.erase("extras");
  if (json.is_structured()) {
    for (auto it = json.begin(); it != json.end(); ++it)
      eraseExtras(*it, inExtension || (json.is_object() && it.key() == "extensions"));
  } else if (inExtension && json.is_number_integer()) {
    const double value = json.get<double>();
    if (std::fabs(value) > double{std::numeric_limits<int>::max()}) json = value;
  }
}

// Removes what tinygltf need not read, and Draco's indices: it refuses them without a buffer view.
void removeOurParts(Json& json) {
  json.erase("buffers");
  json.erase("images");
  json.erase("animations");
  eraseExtras(json);
  const auto meshes = json.find("meshes");
  if (meshes == json.end()) return;
  for (Json& mesh : *meshes) {
    if (!mesh.contains("primitives")) continue;
    for (Json& primitive : mesh["primitives"]) {
      if (extensionOf(primitive, "KHR_draco_mesh_compression")) primitive.erase("indices");
    }
  }
}

}  // namespace

GltfModel::GltfModel(const fs::path& file, SceneBuilder& builder) : file_(file), builder_(builder) {
  GltfDocument document = readGltfDocument(file);
  requireValid(document, [&](const std::string& text) { builder_.warn(text); });
  checkExtensions(document, builder);
  if (const auto it = document.json.find("animations"); it != document.json.end() && !it->empty())
    warn("animations are ignored: the scene stands as its nodes do");
  readBuffers(document);
  openViews(document.json);
  openImages(document.json);

  removeOurParts(document.json);
  const std::string text = document.json.dump();
  document.json = {};
  tinygltf::TinyGLTF parser;
  std::string problem, warnings;
  if (!parser.LoadASCIIFromString(&model_, &problem, &warnings, text.data(),
                                  static_cast<unsigned>(text.size()), "")) {
    throw InputError(
        file, "cannot read the glTF: " + problem.substr(0, problem.find('\n')) + kExportAgain);
  }
}

fs::path GltfModel::pathOf(const std::string& uri, const std::string& pointer) const {
  const std::string name = decodedUri(uri);
  const size_t colon = name.find(':');
  if (colon != std::string::npos && colon < name.find('/'))
    fail(pointer,
         "names '" + name.substr(0, 60) + "', which is no file beside the scene" + kExportAgain);
  return (file_.parent_path() / name).lexically_normal();
}

void GltfModel::readBuffers(GltfDocument& document) {
  if (!document.json.contains("buffers")) return;
  const Json& list = document.json["buffers"];
  for (size_t i = 0; i < list.size(); ++i) {
    const Json& buffer = list[i];
    const std::string pointer = gltfPointer("buffers", i);
    const auto length = buffer["byteLength"].get<uint64_t>();
    std::string bytes;
    if (const auto it = buffer.find("uri"); it != buffer.end()) {
      const std::string uri = *it;
      if (isDataUri(uri)) {
        bytes = decodeData(file_, pointer + "/uri", uri);
      } else {
        const fs::path path = pathOf(uri, pointer + "/uri");
        if (!isRegularFile(path))
          fail(pointer + "/uri",
               whyUnreadable(path, "file") + ": " + path.string() + "; put it there");
        builder_.addFile(path);
        bytes = readText(path);
      }
    } else if (i == 0 && document.hasBinary) {
      bytes = std::move(document.binary);
    } else if (!extensionOf(buffer, "EXT_meshopt_compression")) {  // else nobody reads it
      fail(pointer, std::string("has neither a uri nor a BIN chunk") + kExportAgain);
    } else {
      buffers_.emplace_back();
      continue;
    }
    if (bytes.size() < length) {
      fail(pointer, "holds " + std::to_string(bytes.size()) + " of its " + std::to_string(length) +
                        " bytes" + kExportAgain);
    }
    bytes.resize(length);
    buffers_.push_back(std::move(bytes));
  }
}

void GltfModel::openViews(const Json& json) {
  if (!json.contains("bufferViews")) return;
  const Json& list = json["bufferViews"];
  views_.resize(list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string pointer = gltfPointer("bufferViews", i);
    if (const Json* compressed = extensionOf(list[i], "EXT_meshopt_compression")) {
      const std::string at = pointer + "/extensions/EXT_meshopt_compression";
      const std::string_view from = buffers_[(*compressed)["buffer"].get<size_t>()];
      const auto offset = compressed->value("byteOffset", size_t{0});
      const auto length = (*compressed)["byteLength"].get<size_t>();
      if (offset > from.size() || length > from.size() - offset)
        fail(at, std::string("reaches beyond the end of its buffer") + kExportAgain);
      decompressed_.push_back(std::make_unique<std::string>(
          decodeMeshopt(file_, at, *compressed, from.substr(offset, length))));
      views_[i] = {*decompressed_.back(), (*compressed)["byteStride"].get<size_t>()};
      continue;
    }
    const std::string_view from = buffers_[list[i]["buffer"].get<size_t>()];
    const auto offset = list[i].value("byteOffset", size_t{0});
    const auto length = list[i]["byteLength"].get<size_t>();
    if (offset > from.size() || length > from.size() - offset)
      fail(pointer, std::string("reaches beyond the end of its buffer") + kExportAgain);
    views_[i] = {from.substr(offset, length), list[i].value("byteStride", size_t{0})};
  }
}

void GltfModel::openImages(const Json& json) {
  if (!json.contains("images")) return;
  const Json& list = json["images"];
  for (size_t i = 0; i < list.size(); ++i) {
    const std::string pointer = gltfPointer("images", i);
    const fs::path embedded = file_.string() + "#" + pointer;
    const auto uri = list[i].find("uri");
    if (const auto view = list[i].find("bufferView"); view != list[i].end()) {
      const std::string_view bytes = views_[view->get<size_t>()].bytes;
      images_.push_back({embedded, std::make_shared<const std::string>(bytes)});
    } else if (uri == list[i].end()) {
      fail(pointer, std::string("has neither a uri nor a bufferView") + kExportAgain);
    } else if (isDataUri(*uri)) {
      images_.push_back({embedded, std::make_shared<const std::string>(
                                       decodeImage(file_, pointer + "/uri", *uri))});
    } else {
      images_.push_back({pathOf(*uri, pointer + "/uri"), nullptr});
    }
  }
}

}  // namespace bnvpl
