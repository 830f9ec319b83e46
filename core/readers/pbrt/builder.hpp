// The interpreter of a pbrt file: executes statements one by one, and ends with a scene.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/base/thread_pool.hpp"
#include "core/readers/common/measurements.hpp"
#include "core/readers/pbrt/camera.hpp"
#include "core/readers/pbrt/colour_space.hpp"
#include "core/readers/pbrt/current_transform.hpp"
#include "core/readers/pbrt/lights.hpp"
#include "core/readers/pbrt/media.hpp"
#include "core/readers/pbrt/pictures.hpp"
#include "core/readers/pbrt/shapes.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/readers/pbrt/syntax.hpp"
#include "core/readers/pbrt/textures.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Holds pbrt's graphics state and the scene so far. Include and Import are not its business.
class Builder {
public:
    /// `seconds`: the moment at which all is to stand; none: what the file's shutter opens on.
    Builder(const Sources& sources, std::optional<double> seconds);
    ~Builder() { thread_pool_.finish(); }  // what is under way looks at other members
    Builder(const Builder&) = delete;
    Builder& operator=(const Builder&) = delete;

    void execute(Statement& statement);
    /// Import: what it changes in the graphics state ends with its file.
    void enter();
    void leave();
    /// To be called at the end: what was promised, but did not come, is reported.
    void finish();
    SceneData take() { return std::move(scene_); }

private:
    using Handler = void (Builder::*)(Statement&);
    static const std::map<std::string, Handler>& handlers();

    /// pbrt's graphics state.
    struct State {
        TransformState to_world;
        bool reversed = false;
        ColourSpace space = ColourSpace::srgb;
        std::size_t material = 0;  // index into uses_
        std::optional<AreaLight> lamp;
        std::string inside, outside;  // names of the media there; empty: none
        std::map<std::string, std::vector<std::shared_ptr<const Parameter>>>
            defaults;  // of Attribute, by what they are for
    };
    enum class Block { attribute, transform, object, import };
    struct Saved {
        Block block;
        State state;
        SourceLine where;
    };
    /// A material that shapes may have; one with a name is perhaps made later.
    struct MaterialUse {
        std::optional<MaterialId> made;
        std::string name;
        SourceLine first_use;
    };
    /// A shape that was asked for, with all that was said of it.
    struct WaitingShape {
        std::shared_ptr<MadeShape> made;
        std::size_t material = 0;
        std::optional<TextureId> alpha;
        std::optional<AreaLight> lamp;
        std::string inside, outside;     // names of its media
        bool turned = false;             // its normal is against the one that the shape has by itself
        bool lamp_per_triangle = false;  // for pbrt every triangle of a mesh is a lamp of its own
        std::optional<std::uint32_t> object;
        std::string owner;  // for messages
        std::string name;   // of its file, or of its object
        SourceLine where;
    };

    /// What holds for the next statement, at the moment that is read.
    Matrix to_world();
    Matrix standing(const MovingTransform& transform);

    void attribute_begin(Statement&);
    void attribute_end(Statement&);
    void transform_begin(Statement&);
    void transform_end(Statement&);
    void attribute(Statement&);
    void reverse_orientation(Statement&);
    void world_begin(Statement&);
    void world_end(Statement&);
    void older_business(Statement&);
    void volume(Statement&);
    void option(Statement&);
    void ignored(Statement&);
    void make_named_medium(Statement&);
    void medium_interface(Statement&);
    void color_space(Statement&);
    void push(Block block, const SourceLine& where);
    std::optional<Saved> pop(Block block, const char* what, const SourceLine& where);

    void camera(Statement&);
    void film(Statement&);

    void material(Statement&);
    void make_named_material(Statement&);
    void named_material(Statement&);
    void texture(Statement&);
    Material material_of(const std::string& type, Parameters& parameters);
    std::size_t use_of(const std::string& name, const SourceLine& where);

    void area_light(Statement&);
    void light(Statement&);
    void shape(Statement&);
    void object_begin(Statement&);
    void object_end(Statement&);
    void object_instance(Statement&);
    std::optional<TextureId> alpha_of(Parameters& parameters);
    bool is_nowhere(TextureId alpha) const;

    void check_uses();
    void finish_shapes();
    void finish_shape(WaitingShape& waiting);
    MaterialId with_alpha(MaterialId material, TextureId alpha);
    void find_media();
    void check_medium(const std::string& name, const SourceLine& where);
    std::optional<MediumSides> sides_of(const WaitingShape& waiting) const;
    std::uint16_t filling_of(MaterialId material) const;
    MaterialId filled(MaterialId material, const WaitingShape& waiting);
    void emit(Shape shape, const WaitingShape& waiting);
    void add_shape(Shape shape, const std::optional<std::uint32_t>& object);
    bool add_to_curves(const Shape& shape);
    void finish_film();

    Sources sources_;
    SceneData scene_;
    ThreadPool thread_pool_;
    Pictures pictures_;
    Textures textures_;
    Measurements measurements_;
    Shapes shapes_;
    State state_;
    std::vector<Saved> stack_;
    bool in_world_ = false, ended_ = false;
    float exposure_ = 1;
    Rgb white_{1, 1, 1};
    CurrentTransform transforms_;
    std::optional<double> seconds_;
    std::vector<MaterialUse> uses_;
    std::map<std::string, std::size_t> named_;  // index into uses_
    std::map<std::pair<MaterialId, TextureId>, MaterialId> with_alpha_;
    Media media_;
    std::map<MaterialId, std::uint16_t> fillings_;  // media that materials bring along
    std::string around_;                            // name of the camera's medium
    SourceLine around_where_;
    std::map<std::tuple<MaterialId, std::string, std::string, bool>, MaterialId> filled_;
    std::map<std::string, std::uint32_t> objects_;
    std::optional<std::uint32_t> open_object_;
    std::vector<WaitingShape> waiting_;
    std::optional<std::uint32_t> joined_;  // the object of the last shape
};

}  // namespace lightnet::pbrt
