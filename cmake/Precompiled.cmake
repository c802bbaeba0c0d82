# Precompiles headers that most sources include, which saves about a second per source. Sources still include what
# they use; the sanitizer presets build without precompiled headers (CMAKE_DISABLE_PRECOMPILE_HEADERS).
function(bnvpl_add_precompiled name)  # bnvpl_add_precompiled(name HEADERS...): a target whose headers others reuse
  set(source ${CMAKE_BINARY_DIR}/${name}.cpp)
  file(CONFIGURE OUTPUT ${source} CONTENT "// Only for the headers that come with it.\n")
  add_library(${name} OBJECT ${source})
  target_link_libraries(${name} PRIVATE bnvpl_flags)
  target_precompile_headers(${name} PRIVATE ${ARGN})
endfunction()

# Lets all C++ targets below a directory reuse the headers of target `from`, unless they have some already.
function(bnvpl_precompile directory from)
  get_property(below DIRECTORY ${directory} PROPERTY SUBDIRECTORIES)
  foreach(folder ${below})
    bnvpl_precompile(${folder} ${from})
  endforeach()
  get_property(targets DIRECTORY ${directory} PROPERTY BUILDSYSTEM_TARGETS)
  foreach(target ${targets})
    get_target_property(type ${target} TYPE)
    get_target_property(own ${target} PRECOMPILE_HEADERS)
    get_target_property(reused ${target} PRECOMPILE_HEADERS_REUSE_FROM)
    if(type MATCHES "^(STATIC_LIBRARY|EXECUTABLE)$" AND NOT own AND NOT reused)
      set_target_properties(${target} PROPERTIES PRECOMPILE_HEADERS_REUSE_FROM ${from})
    endif()
  endforeach()
endfunction()
