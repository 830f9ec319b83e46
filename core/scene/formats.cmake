# The readers of Mitsuba, glTF, OBJ and PLY scenes.
target_sources(lightnet_core
  PRIVATE
    assets.cpp mesh_tools.cpp ply_scene.cpp
    mitsuba/document.cpp mitsuba/properties.cpp mitsuba/transforms.cpp mitsuba/colours.cpp mitsuba/textures.cpp
    mitsuba/bsdfs.cpp mitsuba/bsdfs_nested.cpp mitsuba/primitives.cpp mitsuba/serialized.cpp mitsuba/shapes.cpp
    mitsuba/emitters.cpp mitsuba/sky.cpp mitsuba/sensors.cpp mitsuba/mitsuba.cpp
    gltf/json.cpp gltf/document.cpp gltf/accessors.cpp gltf/materials.cpp gltf/meshes.cpp gltf/nodes.cpp gltf/gltf.cpp
    obj/lines.cpp obj/model.cpp obj/materials.cpp obj/obj.cpp
  PUBLIC FILE_SET HEADERS FILES
    assets.hpp mesh_tools.hpp
    mitsuba/document.hpp mitsuba/properties.hpp mitsuba/transforms.hpp mitsuba/colours.hpp mitsuba/textures.hpp
    mitsuba/bsdfs.hpp mitsuba/primitives.hpp mitsuba/serialized.hpp mitsuba/shapes.hpp mitsuba/emitters.hpp
    mitsuba/sky.hpp mitsuba/sensors.hpp mitsuba/mitsuba.hpp
    gltf/json.hpp gltf/document.hpp gltf/materials.hpp gltf/meshes.hpp gltf/nodes.hpp gltf/gltf.hpp
    obj/lines.hpp obj/model.hpp obj/materials.hpp obj/obj.hpp)
target_link_libraries(lightnet_core PRIVATE nlohmann_json::nlohmann_json pugixml::pugixml ZLIB::ZLIB)
