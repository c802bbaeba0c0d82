#include "tools/common/options/film_size.h"

#include <cstdio>

#include "core/errors.h"

namespace bnvpl {

Film parseSize(const std::string& text) {
  unsigned width = 0, height = 0;
  char rest = 0;
  const bool digits = text.find_first_not_of("0123456789x") == std::string::npos;
  if (!digits || text.size() > 11 ||
      std::sscanf(text.c_str(), "%ux%u%c", &width, &height, &rest) != 2 || width < 1 ||
      height < 1 || width > kMaxFilmSide || height > kMaxFilmSide) {
    throw UsageError("--size '" + text + "' is not WIDTHxHEIGHT, such as 640x480, each from 1 to " +
                     std::to_string(kMaxFilmSide));
  }
  return {width, height};
}

std::string sizeText(const Film& film) {
  return std::to_string(film.width) + "x" + std::to_string(film.height);
}

}  // namespace bnvpl
