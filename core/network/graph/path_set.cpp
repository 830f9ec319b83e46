#include "core/network/graph/path_set.hpp"

#include <algorithm>
#include <charconv>
#include <deque>
#include <set>

#include "core/base/error.hpp"

namespace lightnet {
namespace {

constexpr std::string_view letters = "OBDSVE";
// Paths that are told apart by more than so many repetitions are taken for any number of them: nobody needs an example
// that long, and automata stay small.
constexpr std::uint32_t most_repetitions = 16;

// The letters of a word as a reader expects them.
std::string shown(std::string word) {
    for (char& letter : word)
        if (letter == 'O' || letter == 'B') letter = 'L';
    return word;
}

}  // namespace

/// Recursive descent over alternatives, sequences, repetitions and atoms.
class PathSet::Parser {
public:
    explicit Parser(std::string_view text) : text_(text) {}

    PathSet whole() {
        PathSet set = alternatives();
        if (at_ != text_.size()) fail();
        return set;
    }

    static PathSet word(char letter) {
        PathSet set;
        set.begin_ = set.add_state();
        set.end_ = letter ? set.add_state() : set.begin_;
        if (!letter) return set;
        const std::string any = letter == 'L' ? "OB" : letter == '.' ? "SDV" : std::string(1, letter);
        for (const char each : any) set.connect(set.begin_, set.end_, each);
        return set;
    }

private:
    [[noreturn]] void fail() const {
        throw Error("'" + std::string(text_) + "' is no set of light paths: see its place " + std::to_string(at_ + 1));
    }
    bool next_is(char c) const { return at_ < text_.size() && text_[at_] == c; }
    bool take(char c) {
        if (!next_is(c)) return false;
        ++at_;
        return true;
    }

    PathSet alternatives() {
        PathSet set = sequence();
        while (take('|')) set = set.with(sequence());
        return set;
    }

    PathSet sequence() {
        PathSet set = word(0);
        while (at_ < text_.size() && !next_is('|') && !next_is(')')) set = set.then(repeated());
        return set;
    }

    PathSet repeated() {
        PathSet set = atom();
        for (;;) {
            if (take('*'))
                set = times(set, 0, {});
            else if (take('+'))
                set = times(set, 1, {});
            else if (take('?'))
                set = times(set, 0, 1);
            else if (take('{'))
                set = counted(set);
            else
                return set;
        }
    }

    PathSet counted(const PathSet& set) {
        const std::uint32_t least = number();
        const std::uint32_t most = take(',') ? number() : least;
        if (!take('}') || most < least) fail();
        return times(set, std::min(least, most_repetitions),
                     most > most_repetitions ? std::nullopt : std::optional(most));
    }

    static PathSet times(const PathSet& set, std::uint32_t least, std::optional<std::uint32_t> most) {
        PathSet all = word(0);
        for (std::uint32_t i = 0; i < least; ++i) all = all.then(set);
        if (!most) return all.then(any_number(set));
        PathSet rest = word(0);
        for (std::uint32_t i = least; i < *most; ++i) rest = word(0).with(set.then(rest));
        return all.then(rest);
    }

    static PathSet any_number(const PathSet& set) {
        PathSet loop = word(0);
        const auto [first, last] = loop.include(set);
        loop.connect(loop.begin_, first);
        loop.connect(last, loop.end_);
        return loop;
    }

    std::uint32_t number() {
        std::uint32_t value = 0;
        const auto [end, wrong] = std::from_chars(text_.data() + at_, text_.data() + text_.size(), value);
        if (wrong != std::errc{}) fail();
        at_ = static_cast<std::size_t>(end - text_.data());
        return value;
    }

    PathSet atom() {
        if (take('(')) {
            PathSet set = alternatives();
            if (!take(')')) fail();
            return set;
        }
        if (at_ == text_.size() || (text_[at_] != 'L' && text_[at_] != '.' && letters.find(text_[at_]) == letters.npos))
            fail();
        return word(text_[at_++]);
    }

    std::string_view text_;
    std::size_t at_ = 0;
};

PathSet PathSet::parse(std::string_view expression) { return Parser(expression).whole(); }

std::pair<PathSet::State, PathSet::State> PathSet::include(const PathSet& other) {
    const State offset = states_;
    states_ += other.states_;
    for (const auto& [from, to, letter] : other.edges_) connect(from + offset, to + offset, letter);
    return {other.begin_ + offset, other.end_ + offset};
}

PathSet PathSet::then(const PathSet& next) const {
    if (!states_ || !next.states_) return {};
    PathSet all = *this;
    const auto [first, last] = all.include(next);
    all.connect(all.end_, first);
    all.end_ = last;
    return all;
}

PathSet PathSet::with(const PathSet& other) const {
    if (!states_) return other;
    if (!other.states_) return *this;
    PathSet all = *this;
    const auto [first, last] = all.include(other);
    const State begin = all.add_state(), end = all.add_state();
    all.connect(begin, all.begin_);
    all.connect(begin, first);
    all.connect(all.end_, end);
    all.connect(last, end);
    all.begin_ = begin;
    all.end_ = end;
    return all;
}

// A last letter leads to a new end from where the old one could be reached without reading another.
PathSet PathSet::ending_in(std::string_view last) const {
    if (!states_) return {};
    PathSet all = *this;
    const State end = all.add_state();
    for (const auto& [from, to, letter] : edges_) {
        if (!letter || last.find(letter) == last.npos) continue;
        States reached(states_);
        reached[to] = true;
        close(reached);
        if (accepts(reached)) all.connect(from, end, letter);
    }
    all.end_ = end;
    return all;
}

void PathSet::close(States& states) const {
    for (bool grown = true; grown;) {
        grown = false;
        for (const auto& [from, to, letter] : edges_)
            if (!letter && states[from] && !states[to]) grown = states[to] = true;
    }
}

PathSet::States PathSet::begin() const {
    States states(states_);
    if (states_) states[begin_] = true;
    close(states);
    return states;
}

PathSet::States PathSet::after(const States& states, char letter) const {
    States next(states_);
    for (const auto& edge : edges_)
        if (edge.letter == letter && states[edge.from]) next[edge.to] = true;
    close(next);
    return next;
}

// Words by length, and each pair of state sets once: breadth first through both automata.
template <class Wanted>
std::optional<std::string> PathSet::shortest(const PathSet& a, const PathSet& b, std::size_t* left, Wanted wanted) {
    struct StatePair {
        States in_a, in_b;
        std::string word;
    };
    std::deque<StatePair> open{{a.begin(), b.begin(), ""}};
    std::set<std::pair<States, States>> seen{{open.front().in_a, open.front().in_b}};
    for (; !open.empty(); open.pop_front()) {
        if (left && (*left)-- == 0) throw Error("light paths that take too long to tell apart");
        const StatePair& here = open.front();
        if (wanted(a.accepts(here.in_a), b.accepts(here.in_b))) return shown(here.word);
        for (const char letter : letters) {
            StatePair next{a.after(here.in_a, letter), b.after(here.in_b, letter), here.word + letter};
            if (std::find(next.in_a.begin(), next.in_a.end(), true) == next.in_a.end()) continue;  // a has no such word
            if (seen.emplace(next.in_a, next.in_b).second) open.push_back(std::move(next));
        }
    }
    return {};
}

std::optional<std::string> PathSet::common(const PathSet& a, const PathSet& b, std::size_t* left) {
    return shortest(a, b, left, [](bool in_a, bool in_b) { return in_a && in_b; });
}

std::optional<std::string> PathSet::missing(const PathSet& whole, const PathSet& part, std::size_t* left) {
    return shortest(whole, part, left, [](bool in_whole, bool in_part) { return in_whole && !in_part; });
}

bool PathSet::contains(std::string_view word) const { return common(parse(word), *this).has_value(); }

}  // namespace lightnet
