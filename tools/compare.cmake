# lightnet-compare: how far pictures are from a reference.
add_executable(lightnet-compare exr_compare.cpp)
target_link_libraries(lightnet-compare PRIVATE lightnet::core fmt::fmt lightnet_warnings)
install(TARGETS lightnet-compare)

# lightnet-contact-sheet: pairs of pictures beside one another; tools/contact_sheet.sh makes one of a folder of scenes.
add_executable(lightnet-contact-sheet contact_sheet.cpp)
target_link_libraries(lightnet-contact-sheet PRIVATE lightnet::core fmt::fmt lightnet_warnings)
