#include "formats/image/exr_io.h"

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfInputPart.h>
#include <OpenEXR/ImfMultiPartInputFile.h>
#include <OpenEXR/ImfOutputFile.h>
#include <OpenEXR/ImfPartType.h>
#include <OpenEXR/ImfStdIO.h>
#include <OpenEXR/ImfStringAttribute.h>

#include <algorithm>
#include <cmath>
#include <mutex>
#include <stdexcept>

#include "core/files.h"
#include "core/hash.h"
#include "core/read_file.h"
#include "formats/image/exr_header.h"
#include "formats/image/exr_standard.h"

namespace bnvpl {
namespace {

constexpr float kHalfMax = 65504.0f;
constexpr int kMaxExrSide = 1 << 16;
// A file that claims more pixel bytes than so many times its size is damaged. An image of one
// colour reaches 1,700 by ZIP, and 13,000 by DWAB.
constexpr double kMaxExpansion = 4096.0, kMaxDwaExpansion = 65536.0;
constexpr double kMaxPixelBytes = 0x1p34;

// OpenEXR uses no worker threads, and so no global pool.
constexpr int kNoThreads = 0;

void refuseMalformed(const fs::path& file, const Image& image) {
  if (image.width < 1 || image.height < 1 || image.width > kMaxExrSide ||
      image.height > kMaxExrSide) {
    throw OutputError(file, "an image of " + std::to_string(image.width) + " x " +
                                std::to_string(image.height) + " pixels cannot be written");
  }
  const PixelBox box = dataWindowOf(image);
  if (box.x0 < 0 || box.y0 < 0 || box.x1 > image.width || box.y1 > image.height ||
      box.x0 >= box.x1 || box.y0 >= box.y1)
    throw OutputError(file, "the data window is empty or larger than the image");
  if (image.channels.empty()) throw OutputError(file, "the image has no channels");
  for (const ImageChannel& channel : image.channels) {
    if (channel.name.empty() || channel.data.size() != image.pixelCount() ||
        image.find(channel.name) != &channel.data) {
      throw OutputError(file,
                        "channel '" + channel.name + "' is empty, of another size, or there twice");
    }
  }
}

void refuseNonFinite(const fs::path& file, const Image& image) {
  if (const auto bad = findNonFinite(image)) {
    throw std::logic_error(file.string() + ": channel " + bad->channel + ", column " +
                           std::to_string(bad->x) + ", row " + std::to_string(bad->y) +
                           ": not a finite number; not written, the old file, if any, is "
                           "unchanged");
  }
}

Imf::PixelType typeOf(const ImageChannel& channel, ExrPixelType type) {
  return type == ExrPixelType::Half && !needsFloat(channel.name) ? Imf::HALF : Imf::FLOAT;
}

Imf::Header makeHeader(const Image& image, ExrPixelType type) {
  Imf::Header header = standardHeader(image);
  header.compression() = Imf::ZIP_COMPRESSION;
  for (const ImageChannel& channel : image.channels) {
    header.channels().insert(channel.name, Imf::Channel(typeOf(channel, type)));
  }
  for (const auto& [name, text] : image.attributes) {
    header.insert(name, Imf::StringAttribute(text));
  }
  return header;
}

// Clamps values beyond the half range, which would become infinite.
void toHalf(const std::vector<float>& from, std::vector<half>& to, HalfLosses& losses) {
  to.reserve(from.size());
  for (const float value : from) {
    to.emplace_back(std::clamp(value, -kHalfMax, kHalfMax));
    if (std::fabs(value) > kHalfMax) ++losses.beyond;
    if (value != 0.0f && to.back() == 0.0f) ++losses.below;
  }
}

template <typename T>
Imf::Slice sliceOf(Imf::PixelType type, const std::vector<T>& data, int width) {
  // OpenEXR only reads through this pointer.
  char* base = reinterpret_cast<char*>(const_cast<T*>(data.data()));
  return {type, base, sizeof(T), sizeof(T) * static_cast<size_t>(width)};
}

// Refuses sizes that no valid file of this length can hold, before they are allocated.
void refuseAbsurd(const fs::path& file, const Imf::Header& header) {
  const Imath::Box2i &display = header.displayWindow(), &data = header.dataWindow();
  const auto side = [](int low, int high) { return static_cast<double>(high) - low + 1.0; };
  const double width = side(display.min.x, display.max.x);
  const double height = side(display.min.y, display.max.y);
  const double dataWidth = side(data.min.x, data.max.x);
  const double dataHeight = side(data.min.y, data.max.y);
  if (std::max({width, height, dataWidth, dataHeight}) > kMaxExrSide ||
      std::min({width, height, dataWidth, dataHeight}) < 1.0) {
    throw InputError(file, "claims a side of more than " + std::to_string(kMaxExrSide) +
                               " pixels or none; make it again");
  }
  size_t channels = 0;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) ++channels;
  // OpenEXR allocates a tile, and a row of tiles.
  double tiles = 0.0;
  if (header.hasTileDescription()) {
    const double tileWidth = header.tileDescription().xSize;
    tiles = header.tileDescription().ySize * std::max(tileWidth, dataWidth);
  }
  const double pixels = std::max({width * height, dataWidth * dataHeight, tiles});
  const double bytes = pixels * static_cast<double>(channels) * sizeof(float);
  const Imf::Compression c = header.compression();
  const bool dwa = c == Imf::DWAA_COMPRESSION || c == Imf::DWAB_COMPRESSION;
  const double most = dwa ? kMaxDwaExpansion : kMaxExpansion;
  if (bytes > kMaxPixelBytes || bytes > most * static_cast<double>(fs::file_size(file))) {
    throw InputError(file, "claims more pixels than a file of its size can hold; make it again");
  }
}

// Reads scanline by scanline, and keeps the part of each in the display window.
void readPixels(Imf::InputPart& in, Image& image) {
  const Imath::Box2i &display = in.header().displayWindow(), &data = in.header().dataWindow();
  std::vector<std::vector<float>> line(
      image.channels.size(), std::vector<float>(static_cast<size_t>(data.max.x - data.min.x + 1)));
  Imf::FrameBuffer frame;
  for (size_t c = 0; c < line.size(); ++c) {
    char* base = reinterpret_cast<char*>(line[c].data()) -
                 static_cast<std::ptrdiff_t>(data.min.x) * static_cast<int>(sizeof(float));
    // The stride between scanlines is 0, so that all use the same buffer.
    frame.insert(image.channels[c].name, Imf::Slice(Imf::FLOAT, base, sizeof(float), 0));
  }
  in.setFrameBuffer(frame);
  const int left = std::max(display.min.x, data.min.x), right = std::min(display.max.x, data.max.x);
  const int top = std::max(display.min.y, data.min.y);
  const int bottom = std::min(display.max.y, data.max.y);
  if (left > right) return;
  for (int y = top; y <= bottom; ++y) {
    in.readPixels(y);
    for (size_t c = 0; c < line.size(); ++c) {
      const size_t row = static_cast<size_t>(y - display.min.y) * static_cast<size_t>(image.width);
      std::copy(line[c].begin() + (left - data.min.x), line[c].begin() + (right - data.min.x + 1),
                image.channels[c].data.begin() + static_cast<std::ptrdiff_t>(row) +
                    (left - display.min.x));
    }
  }
}

Image readChecked(const fs::path& file) {
  refuseDishonestAttributes(file);
  // Without a limit OpenEXR allocates its line table before it reads.
  static std::once_flag limited;
  std::call_once(limited, [] { Imf::Header::setMaxImageSize(kMaxExrSide, kMaxExrSide); });
  // Not Imf::InputFile: that allocates lines and tiles of any size as it opens the file, and takes
  // deep images.
  Imf::MultiPartInputFile parts(file.c_str(), kNoThreads, /*reconstructChunkOffsetTable=*/false);
  const Imf::Header& header = parts.header(0);
  if (header.type() != Imf::SCANLINEIMAGE && header.type() != Imf::TILEDIMAGE) {
    throw InputError(file, "is a deep image; supply a flat one");
  }
  refuseAbsurd(file, header);
  if (!parts.partComplete(0)) throw InputError(file, "scanlines are missing; make it again");
  Image image;
  image.parts = parts.parts();
  image.width = header.displayWindow().max.x - header.displayWindow().min.x + 1;
  image.height = header.displayWindow().max.y - header.displayWindow().min.y + 1;
  for (auto it = header.channels().begin(); it != header.channels().end(); ++it) {
    if (it.channel().xSampling != 1 || it.channel().ySampling != 1) {
      throw InputError(file, std::string("channel '") + it.name() +
                                 "' is subsampled; save the image with channels R, G and B");
    }
    image.add(it.name());
  }
  for (auto it = header.begin(); it != header.end(); ++it) {
    const auto* text = dynamic_cast<const Imf::StringAttribute*>(&it.attribute());
    // The attribute "type" describes the storage, not the image.
    if (text && std::string(it.name()) != "type") image.attributes[it.name()] = text->value();
  }
  readStandard(header, image);
  Imf::InputPart in(parts, 0);
  readPixels(in, image);
  return image;
}

}  // namespace

bool needsFloat(const std::string& channel) {
  return isDepth(channel) || channel.starts_with("P.") || channel.starts_with("Crypto") ||
         channel == "objectid" || channel == "materialid";
}

HalfLosses writeExr(AtomicFile& file, const Image& image, ExrPixelType type) {
  refuseMalformed(file.target(), image);
  refuseNonFinite(file.target(), image);
  HalfLosses losses;
  // OpenEXR writes to memory, because its file stream does not report a failure of the last write.
  Imf::StdOSStream bytes;
  try {
    const Imf::Header header = makeHeader(image, type);
    std::vector<std::vector<half>> halves(image.channels.size());
    Imf::FrameBuffer frame;
    for (size_t c = 0; c < image.channels.size(); ++c) {
      const ImageChannel& channel = image.channels[c];
      const bool asHalf = typeOf(channel, type) == Imf::HALF;
      if (asHalf) toHalf(channel.data, halves[c], losses);
      frame.insert(channel.name, asHalf ? sliceOf(Imf::HALF, halves[c], image.width)
                                        : sliceOf(Imf::FLOAT, channel.data, image.width));
    }
    Imf::OutputFile out(bytes, header, kNoThreads);
    out.setFrameBuffer(frame);
    const PixelBox box = dataWindowOf(image);
    out.writePixels(box.y1 - box.y0);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& problem) {
    throw OutputError(file.target(), std::string("OpenEXR: ") + problem.what());
  }
  file.write(bytes.str());
  return losses;
}

HalfLosses writeExr(const fs::path& file, const Image& image, ExrPixelType type) {
  AtomicFile out(file);
  const HalfLosses losses = writeExr(out, image, type);
  out.commit();
  return losses;
}

std::optional<NonFinite> findNonFinite(const Image& image) {
  for (const ImageChannel& channel : image.channels) {
    for (size_t i = 0; i < channel.data.size(); ++i) {
      const float value = channel.data[i];
      if (std::isfinite(value) || (isDepth(channel.name) && value > 0.0f)) continue;
      const auto width = static_cast<size_t>(image.width);
      return NonFinite{channel.name, i % width, i / width};
    }
  }
  return {};
}

uint64_t hashImage(const Image& image, ExrPixelType type) {
  std::map<std::string, uint64_t> channels;  // sorted by name, as in OpenEXR
  for (const ImageChannel& channel : image.channels) {
    std::vector<float> rounded;
    const bool asHalf = typeOf(channel, type) == Imf::HALF;
    if (asHalf) {
      std::vector<half> halves;
      HalfLosses ignored;
      toHalf(channel.data, halves, ignored);
      rounded.assign(halves.begin(), halves.end());
    }
    const std::vector<float>& data = asHalf ? rounded : channel.data;
    channels[channel.name] = hashPieces({std::as_bytes(std::span(data))});
  }
  std::string text = std::to_string(image.width) + "x" + std::to_string(image.height);
  for (const auto& [name, hash] : channels) text += "\n" + name + "=" + std::to_string(hash);
  for (const auto& [name, value] : image.attributes) {
    if (name != kImageHashAttribute) text += "\n" + name + ":" + value;
  }
  if (const auto& box = image.dataWindow)
    text += "\n" + std::to_string(hashPieces({bytesOf(*box)}));
  if (const auto& camera = image.camera)
    text += "\n" + std::to_string(hashPieces({bytesOf(*camera)}));
  return hashPieces({std::as_bytes(std::span(text))});
}

Image readExr(const fs::path& file) {
  if (!isRegularFile(file))
    throw InputError(file, whyUnreadable(file, "file") + "; check the name");
  try {
    return readChecked(file);
  } catch (const InputError&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& problem) {
    throw InputError(
        file, std::string("not a whole OpenEXR image: ") + problem.what() + "; make it again");
  }
}

}  // namespace bnvpl
