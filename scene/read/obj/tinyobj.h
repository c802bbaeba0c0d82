// tinyobjloader in double precision, as all files include it.
#pragma once

#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wconversion"
#pragma GCC diagnostic ignored "-Wshadow"
#define TINYOBJLOADER_USE_DOUBLE
#include <tiny_obj_loader.h>
#pragma GCC diagnostic pop
