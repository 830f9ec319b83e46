// Sets of light paths, as regular expressions in Heckbert's notation.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lightnet {

/// A set of light paths, each a word from the light to the eye: L (light), then S (scattered by a mirror or by glass),
/// D (scattered by a surface that is rougher) and V (scattered by a medium), then E (the eye). Heckbert 1990, "Adaptive
/// radiosity textures for bidirectional ray tracing". A value: a finite automaton.
class PathSet {
public:
    /// The empty set.
    PathSet() = default;
    /// Reads letters, `(…)`, `|`, `*`, `+`, `?`, `{n}`, `{least,most}`. L stands for O (a lamp) or B (the background),
    /// `.` for S, D or V: all of these may be named by themselves, too.
    /// The empty text is the word without letters.
    /// Throws Error on anything else.
    static PathSet parse(std::string_view expression);

    /// Every word of this set, continued by every word of `next`.
    PathSet then(const PathSet& next) const;
    /// What is in either set.
    PathSet with(const PathSet& other) const;
    /// Words of this set whose last letter is one of these.
    PathSet ending_in(std::string_view last) const;

    /// A shortest word that both sets have; none: they have none in common. `left`, where sets come from strangers: how
    /// many steps may still be taken, which are taken off; throws Error when there are none.
    static std::optional<std::string> common(const PathSet& a, const PathSet& b, std::size_t* left = nullptr);
    /// A shortest word of `whole` that `part` doesn't have; none: it has all. `left`: see common().
    static std::optional<std::string> missing(const PathSet& whole, const PathSet& part, std::size_t* left = nullptr);
    bool empty() const { return !common(*this, *this); }
    bool contains(std::string_view word) const;

private:
    using State = std::uint32_t;
    struct Edge {
        State from, to;
        char letter;  // 0: none is read
    };
    using States = std::vector<bool>;

    class Parser;
    State add_state() { return states_++; }
    void connect(State from, State to, char letter = 0) { edges_.push_back({from, to, letter}); }
    /// Takes in another automaton; gives its begin and end.
    std::pair<State, State> include(const PathSet& other);
    States begin() const;
    States after(const States& states, char letter) const;
    void close(States& states) const;
    bool accepts(const States& states) const { return states_ > 0 && states[end_]; }
    template <class Wanted>
    static std::optional<std::string> shortest(const PathSet& a, const PathSet& b, std::size_t* left, Wanted wanted);

    std::vector<Edge> edges_;
    State states_ = 0;  // how many; none: the empty set
    State begin_ = 0, end_ = 0;
};

}  // namespace lightnet
