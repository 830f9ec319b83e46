// Light path expressions, as other renderers write them.
#pragma once

#include <string>
#include <vector>

#include "core/network/graph/path_set.hpp"

namespace lightnet {

/// What a collision in a medium counts as.
enum class Collisions {
    rough,  // D, as where light is scattered by a surface: what expressions mean among which none says V
    apart   // V alone
};

/// A set of light paths, written from the eye to the light: `C`, then an event for each corner, then a light. Events
/// are `D` or `<.D>` (anything rougher than a mirror), `S` or `<.S>` (a mirror or glass), `V` or `<V.>` (a collision in
/// a medium) and `.` (any); lights are `L` (any), `O` (a lamp) and `B` (the background), and `<L.'key'>` or `L'key'`
/// (of a group of lamps). `(…)`, `[DS]`, `|`, `*`, `+`, `?`, `{n}` and `{least,most}` are as in regular expressions.
/// Gritz et al., "Open Shading Language", light path expressions; what our operators do not tell apart there
/// (reflection from transmission, glossy from diffuse) is refused. A value.
class PathExpression {
public:
    /// Throws Error, which names the place and what to write instead.
    explicit PathExpression(std::string text);

    /// What it says of lamps of this group; "": of a scene without groups.
    PathSet of(const std::string& group, Collisions collisions) const;
    /// It says V: what it and those beside it call D are surfaces.
    bool names_collisions() const { return names_collisions_; }
    /// The groups that it names.
    const std::vector<std::string>& groups() const { return groups_; }

private:
    class Parser;
    std::string text_;
    std::vector<std::string> groups_;
    bool names_collisions_ = false;
};

}  // namespace lightnet
