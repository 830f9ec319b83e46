// pbrt's participating media.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/sources.hpp"
#include "core/readers/pbrt/substances.hpp"
#include "core/scene/data/scene_data.hpp"

namespace lightnet::pbrt {

/// The named media of one scene. What only absorbs is the business of the glass that it fills, unless somebody stands
/// in it: see be_space().
class Media {
public:
    Media(const Sources& sources, SceneData& scene) : sources_(sources), scene_(scene) {}

    /// MakeNamedMedium. False: there is one of that name already.
    bool define(const std::string& name, const Matrix& to_world, Parameters& parameters);
    /// That medium is one in space, whatever it does to light.
    void be_space(const std::string& name);
    /// One without a name, in space.
    std::uint16_t add(Medium medium);
    /// Is there one of that name?
    bool has(const std::string& name) const { return made_.contains(name); }
    /// What one that is not in space absorbs, per metre; black of others.
    Rgb absorbed_in(const std::string& name) const;
    /// Index of one in space; no_medium of others.
    std::uint16_t index(const std::string& name) const;
    std::vector<std::string> names() const;

private:
    struct Made {
        Medium medium;
        bool in_space = false;
        std::uint16_t index = Query::no_medium;  // in the scene, if it is in space
    };

    std::optional<Medium> medium(const std::string& type, const Matrix& to_world, Parameters& parameters);
    void even(Parameters& parameters, Medium& medium);
    void coloured(Parameters& parameters, Medium& medium, Rgb absorbed, Rgb scattered);
    bool gridded(const std::string& type, const Matrix& to_world, Parameters& parameters, Medium& medium);
    bool shine_of_grid(Parameters& parameters, Medium& medium);
    bool coloured_grid(Parameters& parameters, Medium& medium);
    bool nanovdb(const Matrix& to_world, Parameters& parameters, Medium& medium);
    void cloud(Parameters& parameters, Medium& medium, const Box& box);
    std::optional<Rgb> colour(Parameters& parameters, const char* name);

    Sources sources_;
    SceneData& scene_;
    std::map<std::string, Made> made_;
};

}  // namespace lightnet::pbrt
