# cmake --install: three components, which --component selects.
#   tools   what is built, with manual pages and completion; what the tools say of themselves is asked here
#   data    pipelines, scenes, documentation, licences
#   python  the package bnvpl
find_package(Python3 3.11 COMPONENTS Interpreter)

set(doc_folder ${CMAKE_INSTALL_DATADIR}/doc/bnvpl)
set(made ${CMAKE_BINARY_DIR}/installed)

if(Python3_FOUND)
  install(CODE "
    file(REMOVE_RECURSE \"${made}\")
    file(MAKE_DIRECTORY \"${made}/man\" \"${made}/share\")
    execute_process(COMMAND \"${Python3_EXECUTABLE}\" -B \"${CMAKE_SOURCE_DIR}/install/make_man.py\"
                            --bin \"${CMAKE_RUNTIME_OUTPUT_DIRECTORY}\" --out \"${made}/man\"
                            --version ${PROJECT_VERSION} --prefix \"\${CMAKE_INSTALL_PREFIX}\" COMMAND_ERROR_IS_FATAL ANY)
    execute_process(COMMAND \"${Python3_EXECUTABLE}\" -B \"${CMAKE_SOURCE_DIR}/install/make_completion.py\"
                            --bin \"${CMAKE_RUNTIME_OUTPUT_DIRECTORY}\" --out \"${made}/share\" COMMAND_ERROR_IS_FATAL ANY)"
    COMPONENT tools)
  install(DIRECTORY ${made}/man/ DESTINATION ${CMAKE_INSTALL_MANDIR} COMPONENT tools)
  install(DIRECTORY ${made}/share/ DESTINATION ${CMAKE_INSTALL_DATADIR} COMPONENT tools)
  # Debian's Python in /usr/local looks here; a package for /usr sets lib/python3/dist-packages.
  set(packages "site-packages")
  if(EXISTS /etc/debian_version)
    set(packages "dist-packages")
  endif()
  set(BNVPL_PYTHON_DIR "lib/python${Python3_VERSION_MAJOR}.${Python3_VERSION_MINOR}/${packages}" CACHE STRING
      "folder for the Python package, below the prefix or absolute")
  install(DIRECTORY python/bnvpl DESTINATION ${BNVPL_PYTHON_DIR} COMPONENT python PATTERN __pycache__ EXCLUDE)
else()
  message(STATUS "No Python 3.11: manual pages, completion and the Python package will not be installed")
endif()

install(DIRECTORY pipelines scenes blender DESTINATION ${CMAKE_INSTALL_DATADIR}/bnvpl USE_SOURCE_PERMISSIONS COMPONENT data
        PATTERN __pycache__ EXCLUDE PATTERN ".git*" EXCLUDE REGEX "/blender/tests$" EXCLUDE)

# Pages keep their places, so that their links to each other lead somewhere.
file(GLOB_RECURSE pages RELATIVE ${CMAKE_SOURCE_DIR} CONFIGURE_DEPENDS
     bench/*.md docs/*.md docs/*.csv docs/images/* docs/index.html eval/*.md formats/*.md fuzz/*.md pipelines/*.md python/*.md python/examples/* scenes/*.md
     tools/*.md transport/*.md)
foreach(page README.md CHANGELOG.md CONTRIBUTING.md LICENSE ${pages})
  cmake_path(GET page PARENT_PATH folder)
  install(FILES ${page} DESTINATION ${doc_folder}/${folder} COMPONENT data)
endforeach()

# Licences of what is linked or included; install/THIRD_PARTY.md lists them. A package of Debian brings its own text.
option(BNVPL_INSTALL_LICENCES "install the licences of the libraries" ON)
install(FILES install/THIRD_PARTY.md DESTINATION ${doc_folder} COMPONENT data)
if(BNVPL_INSTALL_LICENCES)
  file(STRINGS install/THIRD_PARTY.md rows REGEX "^\\| `")
  foreach(row ${rows})
    string(REGEX REPLACE "^\\| `([^`]+)`.*" "\\1" package "${row}")
    install(FILES /usr/share/doc/${package}/copyright DESTINATION ${doc_folder}/licences RENAME ${package}
            COMPONENT data OPTIONAL)
  endforeach()
endif()
