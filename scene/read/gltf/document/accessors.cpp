#include "scene/read/gltf/document/accessors.h"

#include <algorithm>
#include <cstring>

namespace bnvpl {

namespace {

// Maximum number of elements without a buffer view, which are all 0: a few bytes of JSON could
// request any amount of memory.
constexpr size_t kMaxZeros = size_t{1} << 16;

// Elements within a buffer view.
struct Elements {
  const char* first = nullptr;
  size_t stride = 0, count = 0, components = 0;
  int componentType = 0;
};

size_t bytesOf(int componentType) {
  const int size = tinygltf::GetComponentSizeInBytes(static_cast<uint32_t>(componentType));
  return size > 0 ? static_cast<size_t>(size) : 0;
}

template <typename T>
T valueAt(const char* bytes) {
  T value;
  std::memcpy(&value, bytes, sizeof value);
  return value;
}

template <typename T>
double integerAt(const char* bytes, bool normalized) {
  const double value = valueAt<T>(bytes);
  return normalized ? std::max(-1.0, value / double{std::numeric_limits<T>::max()}) : value;
}

double numberAt(const char* bytes, int componentType, bool normalized) {
  switch (componentType) {
    case TINYGLTF_COMPONENT_TYPE_BYTE:
      return integerAt<int8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
      return integerAt<uint8_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_SHORT:
      return integerAt<int16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
      return integerAt<uint16_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_INT:
      return integerAt<int32_t>(bytes, normalized);
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      return integerAt<uint32_t>(bytes, normalized);
    default:
      return double{valueAt<float>(bytes)};
  }
}

// Locates elements in a buffer view. Throws GltfError if they do not lie within it.
Elements elementsIn(const GltfModel& model, const std::string& pointer, int bufferView,
                    size_t offset, size_t count, size_t components, int componentType) {
  if (bufferView < 0) model.fail(pointer, std::string("needs a 'bufferView'") + kExportAgain);
  const GltfModel::View view = model.view(static_cast<size_t>(bufferView));
  const size_t size = components * bytesOf(componentType);
  const size_t stride = view.stride > 0 ? view.stride : size;
  if (stride < size) {
    model.fail(pointer, "elements of " + std::to_string(size) + " bytes lie " +
                            std::to_string(stride) + " bytes apart" + kExportAgain);
  }
  if (offset > view.bytes.size() || size > view.bytes.size() - offset ||
      (count - 1) > (view.bytes.size() - offset - size) / stride) {
    model.fail(pointer, std::string("reaches beyond the end of its buffer view") + kExportAgain);
  }
  return {view.bytes.data() + offset, stride, count, components, componentType};
}

template <typename T, typename Read>
void copyElement(const Elements& from, size_t i, const Read& read, T* to) {
  const size_t size = bytesOf(from.componentType);
  for (size_t k = 0; k < from.components; ++k)
    to[k] = read(from.first + i * from.stride + k * size, from.componentType);
}

// read(bytes, componentType) converts a component to a T.
template <typename T, typename Read>
std::vector<T> readElements(const GltfModel& model, int index, size_t components, size_t known,
                            const Read& read) {
  const auto& accessor = model.parts().accessors[static_cast<size_t>(index)];
  const std::string pointer = gltfPointer("accessors", static_cast<size_t>(index));
  const int has = tinygltf::GetNumComponentsInType(static_cast<uint32_t>(accessor.type));
  if (has < 0 || static_cast<size_t>(has) != components) {
    model.fail(pointer, "has " + std::to_string(has) + " numbers an element where " +
                            std::to_string(components) + " are wanted" + kExportAgain);
  }
  const size_t count = accessor.count;
  std::vector<T> out;
  if (accessor.bufferView >= 0) {
    const Elements all = elementsIn(model, pointer, accessor.bufferView, accessor.byteOffset, count,
                                    components, accessor.componentType);
    out.resize(count * components);
    for (size_t i = 0; i < count; ++i) copyElement(all, i, read, &out[i * components]);
  } else if (count > std::max(kMaxZeros, known)) {
    model.fail(pointer,
               "has " + std::to_string(count) + " elements but no 'bufferView'; give it one");
  } else {
    out.resize(count * components);
  }
  if (!accessor.sparse.isSparse) return out;

  const auto& sparse = accessor.sparse;
  const auto changed = static_cast<size_t>(sparse.count);
  if (changed > count)
    model.fail(pointer + "/sparse/count", std::string("exceeds 'count'") + kExportAgain);
  const Elements places = elementsIn(model, pointer + "/sparse/indices", sparse.indices.bufferView,
                                     static_cast<size_t>(sparse.indices.byteOffset), changed, 1,
                                     sparse.indices.componentType);
  const Elements values = elementsIn(model, pointer + "/sparse/values", sparse.values.bufferView,
                                     static_cast<size_t>(sparse.values.byteOffset), changed,
                                     components, accessor.componentType);
  for (size_t i = 0; i < changed; ++i) {
    const double place = numberAt(places.first + i * places.stride, places.componentType, false);
    if (!(place >= 0.0 && place < static_cast<double>(count))) {
      model.fail(pointer + "/sparse/indices",
                 std::string("names an element that is not there") + kExportAgain);
    }
    copyElement(values, i, read, &out[static_cast<size_t>(place) * components]);
  }
  return out;
}

}  // namespace

std::vector<double> readNumbers(const GltfModel& model, int accessor, size_t components,
                                size_t known) {
  const bool normalized = model.parts().accessors[static_cast<size_t>(accessor)].normalized;
  return readElements<double>(model, accessor, components, known, [&](const char* bytes, int type) {
    return numberAt(bytes, type, normalized);
  });
}

std::vector<uint32_t> readIndices(const GltfModel& model, int accessor) {
  switch (model.parts().accessors[static_cast<size_t>(accessor)].componentType) {
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT:
    case TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT:
      break;
    default:
      model.fail(gltfPointer("accessors", static_cast<size_t>(accessor)) + "/componentType",
                 std::string("indices must be unsigned integers") + kExportAgain);
  }
  return readElements<uint32_t>(model, accessor, 1, 0, [](const char* bytes, int type) {
    return static_cast<uint32_t>(numberAt(bytes, type, false));
  });
}

}  // namespace bnvpl
