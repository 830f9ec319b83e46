// pbrt's graphics state, and the blocks that bring an earlier one back.
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/readers/pbrt/colour_space.hpp"
#include "core/readers/pbrt/current_transform.hpp"
#include "core/readers/pbrt/lights.hpp"
#include "core/readers/pbrt/parameters.hpp"
#include "core/readers/pbrt/sources.hpp"

namespace lightnet::pbrt {

/// What holds for the next statement.
struct GraphicsState {
    TransformState to_world;
    bool reversed = false;
    ColourSpace space = ColourSpace::srgb;
    std::size_t material = 0;  // of MaterialUses
    std::optional<AreaLight> lamp;
    std::string inside, outside;  // names of the media there; "": none
    std::map<std::string, std::vector<std::shared_ptr<const Parameter>>>
        defaults;  // of Attribute, by what they are for
};

/// Blocks of a file that are open, inside of each other. What is wrong with them is reported.
class Blocks {
public:
    enum class Kind { attribute, transform, object, import };

    explicit Blocks(const Sources& sources) : sources_(sources) {}

    GraphicsState& state() { return state_; }
    void begin(Kind kind, const SourceLine& where);
    /// The state is that of the block's beginning again; `what` begins such blocks. False: there is none to end.
    bool end(Kind kind, const char* what, const SourceLine& where);
    /// Only the transform becomes that of the beginning.
    void end_transform(const SourceLine& where);
    /// The end of an imported file: no block of it stays open. True: one was an object's.
    bool end_import();
    /// Where no more blocks can end: reports those that are open, and forgets them.
    void end_file();

private:
    struct Open {
        Kind kind;
        GraphicsState before;
        SourceLine where;
    };
    const Sources& sources_;
    GraphicsState state_;
    std::vector<Open> open_;
};

}  // namespace lightnet::pbrt
