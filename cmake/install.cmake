# What `cmake --install` puts where, by components: lightnet and lightnetd (the programs, and what belongs to each),
# lightnet-dev (what a node outside this tree is built against) and python3-lightnet (the module). Packages are the same components (cmake/packages.cmake).
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

# Manual pages, completions and the reference are written by the program itself.
set(manuals "${CMAKE_BINARY_DIR}/share")
add_custom_command(OUTPUT "${manuals}/written"
  COMMAND "${CMAKE_COMMAND}" -E rm -rf "${manuals}"
  COMMAND lightnet manual --all "${manuals}"
  COMMAND "${CMAKE_COMMAND}" -E touch "${manuals}/written"
  DEPENDS lightnet COMMENT "Writing manual pages" VERBATIM)
add_custom_target(manuals ALL DEPENDS "${manuals}/written")

install(TARGETS lightnet RUNTIME COMPONENT lightnet)
install(TARGETS lightnetd RUNTIME COMPONENT lightnetd)
foreach(program IN ITEMS lightnet lightnetd)
  set(mine FILES_MATCHING PATTERN "${program}.1*" PATTERN "${program}-*.1*")
  install(DIRECTORY "${manuals}/man/" DESTINATION "${CMAKE_INSTALL_MANDIR}" COMPONENT ${program} ${mine})
  install(FILES "${manuals}/bash-completion/completions/${program}"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/bash-completion/completions" COMPONENT ${program})
  install(FILES "${manuals}/zsh/vendor-completions/_${program}"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/zsh/vendor-completions" COMPONENT ${program})
  install(FILES "${manuals}/fish/vendor_completions.d/${program}.fish"
    DESTINATION "${CMAKE_INSTALL_DATADIR}/fish/vendor_completions.d" COMPONENT ${program})
endforeach()
# For editors and luacheck.
install(DIRECTORY "${manuals}/lightnet/" DESTINATION "${CMAKE_INSTALL_DATADIR}/lightnet" COMPONENT lightnet)
install(DIRECTORY graphs DESTINATION "${CMAKE_INSTALL_DATADIR}/lightnet" COMPONENT lightnet)
install(PROGRAMS packaging/slurm/lightnet.sbatch DESTINATION "${CMAKE_INSTALL_DATADIR}/lightnet" COMPONENT lightnetd)

# The module for Python is the same for all of its versions.
install(DIRECTORY python/lightnet DESTINATION lib/python3/dist-packages COMPONENT python3-lightnet
  FILES_MATCHING PATTERN "*.py" PATTERN "*.pyi" PATTERN "py.typed" PATTERN "__pycache__" EXCLUDE)

# The unit names the program by where it really is, which is known when it is installed; packages are staged elsewhere.
set(unit_prefix "\${CMAKE_INSTALL_PREFIX}")
if(LIGHTNET_PACKAGES)
  set(unit_prefix "/usr")
endif()
install(CODE "set(LIGHTNET_BINDIR \"${unit_prefix}/${CMAKE_INSTALL_BINDIR}\")
  configure_file(\"${PROJECT_SOURCE_DIR}/packaging/systemd/lightnetd.service.in\" \"${CMAKE_BINARY_DIR}/lightnetd.service\" @ONLY)"
  COMPONENT lightnetd)
install(FILES "${CMAKE_BINARY_DIR}/lightnetd.service" DESTINATION lib/systemd/system COMPONENT lightnetd)

# A node outside the tree: the headers of the rooms that nodes see, and the flags that keep its bits those of ours. What
# they declare is in the programs, which load it (docs/plugins.md), so there is no library to link with.
add_library(lightnet_node INTERFACE)
add_library(lightnet::node ALIAS lightnet_node)
set_target_properties(lightnet_node PROPERTIES EXPORT_NAME node VERIFY_INTERFACE_HEADER_SETS OFF)
set(node_headers "")
foreach(room IN ITEMS base film scene network estimate)
  get_target_property(headers lightnet_${room} HEADER_SET)
  list(APPEND node_headers ${headers})
endforeach()
get_target_property(headers lightnet_readers HEADER_SET)
list(FILTER headers INCLUDE REGEX "core/readers/(files|images|common)/[^/]*$")  # what all readers use, not the readers themselves
list(APPEND node_headers ${headers})
target_sources(lightnet_node INTERFACE FILE_SET HEADERS
  BASE_DIRS "${PROJECT_SOURCE_DIR}" FILES ${node_headers})
target_compile_features(lightnet_node INTERFACE cxx_std_20)
target_compile_options(lightnet_node INTERFACE -ffp-contract=off -march=${LIGHTNET_ARCH})
install(TARGETS lightnet_node EXPORT lightnet
  FILE_SET HEADERS DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/lightnet" COMPONENT lightnet-dev)
install(DIRECTORY "${LIGHTNET_WRITTEN_HEADERS}/core" DESTINATION "${CMAKE_INSTALL_INCLUDEDIR}/lightnet" COMPONENT lightnet-dev)
install(EXPORT lightnet NAMESPACE lightnet:: FILE lightnet-targets.cmake
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/lightnet" COMPONENT lightnet-dev)
configure_package_config_file(cmake/lightnet-config.cmake.in "${CMAKE_BINARY_DIR}/lightnet-config.cmake"
  INSTALL_DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/lightnet" PATH_VARS CMAKE_INSTALL_BINDIR)
write_basic_package_version_file("${CMAKE_BINARY_DIR}/lightnet-config-version.cmake" COMPATIBILITY SameMinorVersion)
install(FILES "${CMAKE_BINARY_DIR}/lightnet-config.cmake" "${CMAKE_BINARY_DIR}/lightnet-config-version.cmake"
  DESTINATION "${CMAKE_INSTALL_LIBDIR}/cmake/lightnet" COMPONENT lightnet-dev)
