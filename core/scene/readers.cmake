# The readers of scenes, and the formats that they read.
target_sources(lightnet_core
  PRIVATE
    files.cpp report.cpp ply.cpp ply_header.cpp spectra.cpp read_scene.cpp
    image_file.cpp image_jpeg.cpp image_png.cpp image_exr.cpp image_hdr.cpp
    pbrt/tokenizer.cpp pbrt/parameters.cpp pbrt/syntax.cpp pbrt/transforms.cpp pbrt/sources.cpp pbrt/pictures.cpp
    pbrt/textures.cpp pbrt/quadrics.cpp pbrt/shapes.cpp pbrt/materials.cpp pbrt/lights.cpp pbrt/camera.cpp
    pbrt/builder.cpp pbrt/builder_world.cpp pbrt/builder_finish.cpp pbrt/meshes.cpp pbrt/subdivision.cpp
    pbrt/colour_space.cpp pbrt/pictured_lights.cpp pbrt/pbrt.cpp gzip.cpp workshop.cpp overrides.cpp statistics.cpp
  PUBLIC FILE_SET HEADERS FILES
    report.hpp ply.hpp ply_header.hpp spectra.hpp read_scene.hpp image_file.hpp image_decoders.hpp
    pbrt/tokenizer.hpp pbrt/parameters.hpp pbrt/syntax.hpp pbrt/transforms.hpp pbrt/sources.hpp pbrt/pictures.hpp
    pbrt/textures.hpp pbrt/quadrics.hpp pbrt/shapes.hpp pbrt/materials.hpp pbrt/lights.hpp pbrt/camera.hpp
    pbrt/builder.hpp pbrt/meshes.hpp pbrt/subdivision.hpp pbrt/colour_space.hpp pbrt/pictured_lights.hpp pbrt/pbrt.hpp
    gzip.hpp workshop.hpp overrides.hpp statistics.hpp)
target_link_libraries(lightnet_core PRIVATE fmt::fmt JPEG::JPEG PNG::PNG OpenEXR::OpenEXR ZLIB::ZLIB Threads::Threads)
