# The readers of scenes, and the formats that they read.
target_sources(lightnet_core
  PRIVATE
    files.cpp report.cpp assets.cpp mesh_tools.cpp ply.cpp ply_header.cpp ply_scene.cpp spectra.cpp read_scene.cpp
    image_file.cpp image_jpeg.cpp image_png.cpp image_exr.cpp image_hdr.cpp
    pbrt/tokenizer.cpp pbrt/parameters.cpp pbrt/syntax.cpp pbrt/transforms.cpp pbrt/sources.cpp pbrt/baking.cpp
    pbrt/textures.cpp pbrt/quadrics.cpp pbrt/shapes.cpp pbrt/materials.cpp pbrt/lights.cpp pbrt/camera.cpp
    pbrt/builder.cpp pbrt/builder_world.cpp pbrt/pbrt.cpp
    mitsuba/document.cpp mitsuba/properties.cpp mitsuba/transforms.cpp mitsuba/colours.cpp mitsuba/textures.cpp
    mitsuba/bsdfs.cpp mitsuba/bsdfs_nested.cpp mitsuba/primitives.cpp mitsuba/serialized.cpp mitsuba/shapes.cpp
    mitsuba/emitters.cpp mitsuba/sky.cpp mitsuba/sensors.cpp mitsuba/mitsuba.cpp
    gltf/json.cpp gltf/document.cpp gltf/accessors.cpp gltf/materials.cpp gltf/meshes.cpp gltf/nodes.cpp gltf/gltf.cpp
    obj/lines.cpp obj/model.cpp obj/materials.cpp obj/obj.cpp
  PUBLIC FILE_SET HEADERS FILES
    assets.hpp mesh_tools.hpp report.hpp ply.hpp ply_header.hpp spectra.hpp read_scene.hpp image_file.hpp image_decoders.hpp
    pbrt/tokenizer.hpp pbrt/parameters.hpp pbrt/syntax.hpp pbrt/transforms.hpp pbrt/sources.hpp pbrt/baking.hpp
    pbrt/textures.hpp pbrt/quadrics.hpp pbrt/shapes.hpp pbrt/materials.hpp pbrt/lights.hpp pbrt/camera.hpp
    pbrt/builder.hpp pbrt/pbrt.hpp
    mitsuba/document.hpp mitsuba/properties.hpp mitsuba/transforms.hpp mitsuba/colours.hpp mitsuba/textures.hpp
    mitsuba/bsdfs.hpp mitsuba/primitives.hpp mitsuba/serialized.hpp mitsuba/shapes.hpp mitsuba/emitters.hpp
    mitsuba/sky.hpp mitsuba/sensors.hpp mitsuba/mitsuba.hpp
    gltf/json.hpp gltf/document.hpp gltf/materials.hpp gltf/meshes.hpp gltf/nodes.hpp gltf/gltf.hpp
    obj/lines.hpp obj/model.hpp obj/materials.hpp obj/obj.hpp)
target_link_libraries(lightnet_core PRIVATE fmt::fmt JPEG::JPEG PNG::PNG OpenEXR::OpenEXR pugixml::pugixml ZLIB::ZLIB)
