# Writes HEADER with the version of Embree and the build id: a hash of it, of FLAVOUR, of those FLAGS of the compiler
# that change arithmetic, and of all sources that determine what the tools compute. Folders, debug information and
# hardening do not change it.
# Runs at each build: cmake -DSOURCE=... -DHEADER=... -DFLAVOUR=... -DFLAGS=... -DEMBREE=... -P build_id.cmake
file(GLOB_RECURSE files RELATIVE ${SOURCE}
     ${SOURCE}/core/* ${SOURCE}/formats/* ${SOURCE}/spatial/* ${SOURCE}/scene/* ${SOURCE}/transport/* ${SOURCE}/images/*
     ${SOURCE}/tools/* ${SOURCE}/cmake/*)
list(FILTER files INCLUDE REGEX "(\\.(h|cpp|cmake)|CMakeLists\\.txt)$")
list(FILTER files EXCLUDE REGEX "_test\\.cpp$|^cmake/Install\\.cmake$")
list(APPEND files CMakeLists.txt)
list(SORT files)
string(REGEX MATCHALL "(^| )-(m|f[a-z-]*math|ffp-|fexcess-|Ofast)[^ ]*" arithmetic "${FLAGS}")
list(JOIN arithmetic "" arithmetic)
set(all "${FLAVOUR}${arithmetic} embree=${EMBREE}")
foreach(file ${files})
  file(SHA256 ${SOURCE}/${file} hash)
  string(APPEND all "${file} ${hash}\n")
endforeach()
string(SHA256 hash "${all}")
string(SUBSTRING ${hash} 0 12 id)
set(text "#pragma once\n#define BNVPL_BUILD_ID \"${id}\"\n#define BNVPL_EMBREE \"${EMBREE}\"\n")
set(old "")
if(EXISTS ${HEADER})
  file(READ ${HEADER} old)
endif()
if(NOT old STREQUAL text)
  file(WRITE ${HEADER} "${text}")
endif()
