# lightnet-compare: how far pictures are from a reference.
add_executable(lightnet-compare exr_compare.cpp)
target_link_libraries(lightnet-compare PRIVATE lightnet::core fmt::fmt lightnet_warnings)
install(TARGETS lightnet-compare)
