# The shared libraries of the public interface, and what `cmake --install` installs.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Adds a shared library. Links the object files of modules instead of the modules, because these would also link image
# libraries. If a symbol is missing, the linker reports it. A program must link only one of both libraries, because both
# contain the physics.
function(weft_shared_library target name)
  cmake_parse_arguments(PARSE_ARGV 2 library "" "" "MODULES;SOURCES;LINKS")
  set(objects "")
  foreach(module IN LISTS library_MODULES)
    list(APPEND objects $<TARGET_OBJECTS:weft_${module}>)
  endforeach()
  add_library(${target} SHARED ${library_SOURCES} ${objects})
  target_include_directories(${target} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}
                             PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/api/physics_library/include>
                             $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/api/library/include>
                             $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>)
  target_compile_features(${target} INTERFACE cxx_std_20)
  target_link_libraries(${target} PRIVATE weft_warnings Eigen3::Eigen TBB::tbb Threads::Threads PkgConfig::fmt
                                          ${library_LINKS})
  target_link_options(${target} PRIVATE -Wl,--as-needed -Wl,-z,defs)
  set_target_properties(${target} PROPERTIES OUTPUT_NAME ${name} EXPORT_NAME ${name} LINKER_LANGUAGE CXX
                        VERSION ${PROJECT_VERSION} SOVERSION ${PROJECT_VERSION_MAJOR}.${PROJECT_VERSION_MINOR})
  add_library(Weft::${name} ALIAS ${target})
endfunction()
set(physics_modules core mesh solver forces integrator collision untangle motion model simulation physics_library)
weft_shared_library(weft_physics_shared weft-physics MODULES ${physics_modules})
weft_shared_library(weft_shared weft
                    MODULES ${physics_modules} scene character assets garment environment production library
                    SOURCES api/library/host_pictures.cpp film/image/color.cpp film/image/picture.cpp
                    LINKS PkgConfig::tomlplusplus PkgConfig::pugixml assimp::assimp)

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME library)
install(TARGETS weft_shared weft_physics_shared EXPORT Weft LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY api/physics_library/include/weft api/library/include/weft DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
set(config_folder ${CMAKE_INSTALL_LIBDIR}/cmake/Weft)
install(EXPORT Weft FILE WeftConfig.cmake NAMESPACE Weft:: DESTINATION ${config_folder})
# If Weft_DIR is the build folder, other programs find the library there without an installation.
export(EXPORT Weft FILE ${PROJECT_BINARY_DIR}/WeftConfig.cmake NAMESPACE Weft::)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/WeftConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/WeftConfigVersion.cmake DESTINATION ${config_folder})

if(WEFT_PYTHON)
  set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME python)
  set(WEFT_PYTHON_FOLDER lib/python3/dist-packages CACHE STRING "Where the Python module is installed, below the prefix")
  install(DIRECTORY api/python/weft DESTINATION ${WEFT_PYTHON_FOLDER})
  install(TARGETS weft_extension LIBRARY DESTINATION ${WEFT_PYTHON_FOLDER}/weft)
endif()

set(CMAKE_INSTALL_DEFAULT_COMPONENT_NAME program)
# The installation runs the program to write its manual page, completions and schema (install_output).
install(TARGETS weft weft_tools_program RUNTIME)
install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/weft)
install(FILES ${PROJECT_SOURCE_DIR}/LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
# Installs the output of `weft` with the further arguments as `file`, relative to the prefix.
function(install_output file)
  cmake_path(GET file PARENT_PATH folder)
  install(CODE "
    set(prefix \"\$ENV{DESTDIR}\${CMAKE_INSTALL_PREFIX}\")
    file(MAKE_DIRECTORY \"\${prefix}/${folder}\")
    execute_process(COMMAND \"\${prefix}/${CMAKE_INSTALL_BINDIR}/weft\" ${ARGN}
                    OUTPUT_FILE \"\${prefix}/${file}\" COMMAND_ERROR_IS_FATAL ANY)
    message(STATUS \"Installing: \${prefix}/${file}\")")
endfunction()
install_output(${CMAKE_INSTALL_MANDIR}/man1/weft.1 man)
install_output(${CMAKE_INSTALL_DATADIR}/weft/scene.schema.json schema)
install_output(${CMAKE_INSTALL_DATADIR}/bash-completion/completions/weft completion bash)
install_output(${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions/_weft completion zsh)
install_output(${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d/weft.fish completion fish)

# Settings of the Debian package: ninja package
set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_DIRECTORY ${CMAKE_BINARY_DIR}/packages)
set(CPACK_PACKAGE_CONTACT "Weft")
set(CPACK_PACKAGE_DESCRIPTION_SUMMARY "Simulation and rendering of cloth")
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_STRIP_FILES ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PACKAGE_DEPENDS "libosmesa6 | libegl1, libosmesa6 | libgl1-mesa-dri")  # weft opens them at run time
if(WEFT_PYTHON)
  string(APPEND CPACK_DEBIAN_PACKAGE_DEPENDS ", python3, python3-numpy")
endif()
include(CPack)

# An archive that uses no libraries of the machine on which it runs: ninja bundle
add_executable(weft_start EXCLUDE_FROM_ALL ${PROJECT_SOURCE_DIR}/.packaging/start.c)
target_compile_options(weft_start PRIVATE -march=x86-64 -Wall -Wextra)  # it also runs on older CPUs
target_link_options(weft_start PRIVATE -static)
add_custom_target(bundle
                  COMMAND ${PROJECT_SOURCE_DIR}/.packaging/bundle.sh ${CMAKE_BINARY_DIR} $<TARGET_FILE:weft_start>
                          ${CPACK_PACKAGE_DIRECTORY}
                  DEPENDS weft weft_tools_program weft_start VERBATIM USES_TERMINAL)
