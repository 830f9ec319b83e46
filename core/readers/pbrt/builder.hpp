// The interpreter of a pbrt file: executes statements one by one, and ends with a scene.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/thread_pool.hpp"
#include "core/readers/common/measurements.hpp"
#include "core/readers/pbrt/camera.hpp"
#include "core/readers/pbrt/current_transform.hpp"
#include "core/readers/pbrt/eye.hpp"
#include "core/readers/pbrt/graphics_state.hpp"
#include "core/readers/pbrt/material_uses.hpp"
#include "core/readers/pbrt/media.hpp"
#include "core/readers/pbrt/objects.hpp"
#include "core/readers/pbrt/pictures.hpp"
#include "core/readers/pbrt/shapes.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/readers/pbrt/syntax.hpp"
#include "core/readers/pbrt/textures.hpp"
#include "core/readers/pbrt/waiting_shapes.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// Holds the scene so far. Include and Import are not its business.
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
    using Handler = void (*)(Builder&, Statement&);
    template <void (Builder::*handle)(Statement&)>
    static void call(Builder& builder, Statement& statement) {
        (builder.*handle)(statement);
    }
    static const std::map<std::string, Handler>& handlers();

    /// What holds for the next statement.
    GraphicsState& state() { return blocks_.state(); }
    /// Its transform at the moment that is read.
    Matrix to_world();
    Matrix standing(const MovingTransform& transform);

    void attribute(Statement&);
    void world_end(Statement&);
    void older_business(Statement&);
    void volume(Statement&);
    void option(Statement&);
    void make_named_medium(Statement&);
    void medium_interface(Statement&);
    void color_space(Statement&);

    void camera(Statement&);

    void material(Statement&);
    void make_named_material(Statement&);
    void named_material(Statement&);
    void texture(Statement&);
    Material material_of(const std::string& type, Parameters& parameters);

    void area_light(Statement&);
    void light(Statement&);
    void shape(Statement&);
    std::optional<TextureId> alpha_of(Parameters& parameters);

    Sources sources_;
    SceneData scene_;
    ThreadPool thread_pool_;
    Pictures pictures_;
    Textures textures_;
    Measurements measurements_;
    Shapes shapes_;
    Media media_;
    MaterialUses materials_;
    WaitingShapes waiting_;
    Blocks blocks_;
    Objects objects_;
    Eye eye_;
    bool in_world_ = false, ended_ = false;
    CurrentTransform transforms_;
    std::optional<double> seconds_;
};

}  // namespace lightnet::pbrt
