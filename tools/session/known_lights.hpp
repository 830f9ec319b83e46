// Lights of which all samples are there before a picture is rendered.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <vector>

#include "core/film/film.hpp"
#include "core/network/graph/graph.hpp"
#include "tools/pictures/picture_recipe.hpp"

namespace lightnet {

/// What a film holds of some of its colours, in this order.
FilmState colours_of(const FilmState& film, std::span<const std::size_t> colours, std::size_t all);

/// Belongs to one picture; a thread at a time.
// DECISIONS: lights-by-recipe
class KnownLights {
public:
    KnownLights() = default;
    /// Of a film of that format. `graph`: its own; rest() is that without them.
    KnownLights(FilmFormat format, Graph graph) : format_(std::move(format)), rest_(std::move(graph)) {}

    /// False: it is not all of such colours of such a film.
    bool add(const LightRecipe& recipe, FilmState state);
    /// Leaves out what can't be left out of the graph.
    void settle(const Registry& registry);

    bool empty() const { return lights_.empty(); }
    /// Of the layers.
    std::vector<std::string> names() const;
    /// The graph that is still to be rendered.
    const Graph& rest() const { return rest_; }
    /// The pixels of a tile in which they are black, with about as much of them as its samples would bring: to be
    /// looked at.
    std::vector<Rgb> shown_in(const Tile& tile, std::span<const Rgb> pixels) const;
    /// Takes them for what they are in a film of which all else is there. Throws Error where that was cut in another
    /// way.
    void complete(Film& film);
    /// There are some, and the film shows no more than something of them.
    bool are_shown() const { return !lights_.empty() && !completed_; }

private:
    struct Light {
        LightRecipe recipe;
        FilmState state;
        std::vector<Rgb> means;  // pixel × colour
    };

    FilmFormat format_;
    Graph rest_;
    std::vector<Light> lights_;
    bool completed_ = false;
};

}  // namespace lightnet
