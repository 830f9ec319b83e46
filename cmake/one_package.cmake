# Read by cpack for each generator: debug symbols go into packages of their own where those exist, and nowhere else.
if(NOT CPACK_GENERATOR STREQUAL "DEB")
  set(CPACK_STRIP_FILES ON)
endif()
