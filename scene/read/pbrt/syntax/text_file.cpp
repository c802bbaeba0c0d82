#include "scene/read/pbrt/syntax/text_file.h"

#include <zlib.h>

#include <algorithm>
#include <memory>

#include "core/files.h"
#include "core/read_file.h"

namespace bnvpl::pbrt {

namespace {

constexpr size_t kMaxUnpacked = size_t{1} << 34;  // bytes; a larger text is a mistake

std::string unpacked(const fs::path& file, const std::string& packed) {
  z_stream stream{};
  constexpr int kGzip = 16 + MAX_WBITS;
  if (inflateInit2(&stream, kGzip) != Z_OK) throw MemoryError("zlib cannot start");
  const std::unique_ptr<z_stream, int (*)(z_stream*)> end(&stream, inflateEnd);
  std::string out;
  size_t taken = 0;
  for (int state = Z_OK; state != Z_STREAM_END;) {
    if (stream.avail_in == 0) {
      constexpr size_t kPiece = size_t{1} << 30;  // avail_in has 32 bits
      const size_t piece = std::min(packed.size() - taken, kPiece);
      stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(packed.data() + taken));
      stream.avail_in = static_cast<uInt>(piece);
      taken += piece;
    }
    const size_t had = out.size(), more = std::clamp(had, size_t{1} << 16, size_t{1} << 26);
    if (had + more > kMaxUnpacked) throw InputError(file, "unpacks to more than 16 GiB");
    out.resize(had + more);
    stream.next_out = reinterpret_cast<Bytef*>(out.data() + had);
    stream.avail_out = static_cast<uInt>(more);
    state = inflate(&stream, Z_NO_FLUSH);
    out.resize(had + more - stream.avail_out);
    const bool stuck = out.size() == had && stream.avail_in == 0 && taken == packed.size();
    if ((state != Z_OK && state != Z_STREAM_END && state != Z_BUF_ERROR) ||
        (state != Z_STREAM_END && stuck)) {
      throw InputError(file, "is damaged: gzip cannot unpack it; supply the whole file");
    }
    const bool another = state == Z_STREAM_END && (stream.avail_in > 0 || taken < packed.size());
    if (another && inflateReset(&stream) == Z_OK) state = Z_OK;  // gzip files may be concatenated
  }
  return out;
}

}  // namespace

std::string readPacked(const fs::path& file) {
  if (!isRegularFile(file))
    throw InputError(file, whyUnreadable(file, "file") + "; check its name");
  std::string text = readText(file);
  const bool packed = text.size() > 2 && text[0] == '\x1f' && text[1] == '\x8b';
  if (packed) text = unpacked(file, text);
  requireNoUtf16(file, text);
  if (text.starts_with("\xef\xbb\xbf")) text.erase(0, 3);  // the byte order mark of UTF-8
  return text;
}

}  // namespace bnvpl::pbrt
