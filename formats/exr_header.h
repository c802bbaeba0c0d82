// A look at the attributes of an OpenEXR file before OpenEXR sees them. Internal to exr_io.cpp.
#pragma once

#include "core/errors.h"

namespace bnvpl {

// OpenEXR 3.1 allocates what an attribute claims before it reads it: 2 GiB for a file of a hundred
// bytes. And it believes the claim for some types and not for others, so that an attribute with a
// wrong size can hide the next from whoever walks over them.
// Throws InputError when an attribute claims more than the file has, or another size than its type,
// and for ID manifests, of which OpenEXR 3.1 reads more than there is.
// Damage beyond that is left to OpenEXR.
void refuseDishonestAttributes(const fs::path& file);

}  // namespace bnvpl
