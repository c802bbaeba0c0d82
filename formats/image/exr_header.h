// Checks the attributes of an OpenEXR file before OpenEXR reads them. Internal to exr_io.cpp.
#pragma once

#include "core/errors.h"

namespace bnvpl {

// OpenEXR 3.1 allocates the claimed size of an attribute before it reads it: up to 2 GiB for a file
// of a hundred bytes. It uses the claimed size for some types only, so that an attribute of wrong
// size can hide the next one from a reader that skips by size. Throws InputError if an attribute
// claims more than the file has, or another size than its type, and for ID manifests, which OpenEXR
// 3.1 reads beyond their end. OpenEXR itself detects other damage.
void refuseDishonestAttributes(const fs::path& file);

}  // namespace bnvpl
