// Writes images with values that the project's own writer refuses.
#pragma once

#include <OpenEXR/ImfChannelList.h>
#include <OpenEXR/ImfFrameBuffer.h>
#include <OpenEXR/ImfHeader.h>
#include <OpenEXR/ImfOutputFile.h>

#include "formats/image/image.h"

namespace bnvpl {

inline void writeForeignExr(const std::string& file, const Image& image) {
  Imf::Header header(image.width, image.height);
  Imf::FrameBuffer frame;
  for (const ImageChannel& channel : image.channels) {
    header.channels().insert(channel.name, Imf::Channel(Imf::FLOAT));
    char* data = reinterpret_cast<char*>(const_cast<float*>(channel.data.data()));  // only read
    frame.insert(channel.name, Imf::Slice(Imf::FLOAT, data, sizeof(float),
                                          sizeof(float) * static_cast<size_t>(image.width)));
  }
  Imf::OutputFile out(file.c_str(), header);
  out.setFrameBuffer(frame);
  out.writePixels(image.height);
}

}  // namespace bnvpl
