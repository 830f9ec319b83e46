#include "core/network/graph/path_expression.hpp"

#include <algorithm>
#include <cctype>
#include <string_view>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"

namespace lightnet {
namespace {

constexpr std::string_view no_path = "(EL)";  // no light comes behind an eye

// Expressions come from strangers as well: what one of these sizes says can be looked at in no time.
constexpr std::size_t most_length = 1024, most_letters = 128;  // as it is, and with its repetitions written out
constexpr int most_nesting = 32;

/// In Heckbert's notation, which goes from the light to the eye.
struct ScopedActivity {
    std::string text;
    std::size_t letters = 0;  // with its repetitions written out
};

}  // namespace

/// Recursive descent, which puts the last thing of each sequence first. Lights of other groups are no paths.
class PathExpression::Parser {
public:
    Parser(std::string_view text, const std::string& group, Collisions collisions)
        : text_(text), group_(group), collisions_(collisions) {}

    std::string whole() {
        if (text_.size() > most_length) fail("it is too long");
        const ScopedActivity turned = alternatives();
        if (at_ != text_.size()) fail("this closes nothing");
        return turned.text;
    }
    /// That were met.
    std::vector<std::string> groups() { return std::move(groups_); }

private:
    [[noreturn]] void fail(const std::string& why) const {
        throw Error(in_quotes(std::string(text_)) + " is no light path expression: place " + std::to_string(at_ + 1) +
                    ": " + why);
    }
    void skip_blanks() {
        while (at_ < text_.size() && std::isspace(static_cast<unsigned char>(text_[at_]))) ++at_;
    }
    bool next_is(char c) {
        skip_blanks();
        return at_ < text_.size() && text_[at_] == c;
    }
    bool take(char c) {
        if (!next_is(c)) return false;
        ++at_;
        return true;
    }
    char letter() {
        skip_blanks();
        return at_ < text_.size() ? text_[at_++] : '\0';
    }

    ScopedActivity alternatives() {
        if (++nesting_ > most_nesting) fail("it is nested too deeply");
        ScopedActivity all = sequence();
        while (take('|')) all = either(all, sequence());
        --nesting_;
        return {"(" + all.text + ")", all.letters};
    }

    static ScopedActivity either(const ScopedActivity& one, const ScopedActivity& other) {
        return {one.text + "|" + other.text, one.letters + other.letters};
    }

    ScopedActivity sequence() {
        ScopedActivity all;
        while (!next_is('|') && !next_is(')') && at_ < text_.size()) {
            const ScopedActivity one = repeated(atom());
            all = {one.text + all.text, one.letters + all.letters};
            if (all.letters > most_letters) fail("it is too long with its repetitions");
        }
        return all;
    }

    // What it counts is the same in both directions.
    ScopedActivity repeated(ScopedActivity one) {
        for (;;) {
            if (next_is('*') || next_is('+') || next_is('?')) {
                one = {one.text + letter(), 2 * one.letters};
            } else if (take('{')) {
                const std::string least = number(), most = take(',') ? number() : least;
                if (!take('}')) fail("a } is missing");
                if (std::stoul(most) < std::stoul(least)) fail("it ends before it begins");
                one = {one.text + "{" + least + "," + most + "}", (std::stoul(most) + 1) * one.letters};
            } else {
                return one;
            }
            if (one.letters > most_letters) fail("it is too long with its repetitions");
        }
    }

    std::string number() {
        std::string digits;
        skip_blanks();
        while (at_ < text_.size() && std::isdigit(static_cast<unsigned char>(text_[at_]))) digits += text_[at_++];
        if (digits.empty() || digits.size() > 3) fail("a number of up to three digits is missing");
        return digits;
    }

    ScopedActivity atom() {
        if (take('(')) {
            ScopedActivity some = alternatives();
            if (!take(')')) fail("a ) is missing");
            return some;
        }
        if (take('[')) return any_of();
        if (take('<')) return event();
        const char c = letter();
        if (c == 'C') return {"E", 1};
        if (c == 'L' || c == 'O' || c == 'B') return {light(c), 1};
        return scattering(c);
    }

    ScopedActivity scattering(char how) {
        if (how == '.') return {".", 2};
        if (how == 'D' && collisions_ == Collisions::rough) return {"(D|V)", 2};
        if (how != 'D' && how != 'S' && how != 'V') {
            if (how) --at_;
            refuse(how);
        }
        return {std::string(1, how), 1};
    }

    ScopedActivity any_of() {
        if (next_is('^')) fail("sets of what is not meant are not known here: name what is");
        ScopedActivity all = atom();
        while (!take(']')) {
            if (at_ >= text_.size()) fail("a ] is missing");
            all = either(all, atom());
        }
        return {"(" + all.text + ")", all.letters};
    }

    // <.D>, <V.>, <L.'key'>: what happens, how, and a label.
    ScopedActivity event() {
        const char what = letter();
        ScopedActivity turned;
        if (what == 'L' || what == 'O' || what == 'B') {
            if (!take('.')) fail("a light is written <L.> or <L.'group'>");
            turned = {light(what), 1};
        } else if (what == 'V') {
            if (!take('.')) fail("a collision in a medium is written V or <V.>");
            turned = scattering(what);
        } else {
            if (what != '.') {
                if (what) --at_;
                refuse(what);
            }
            turned = scattering(letter());
        }
        if (!take('>')) fail("a > is missing");
        return turned;
    }

    std::string light(char which) {
        const std::string turned(1, which);
        if (!take('\'')) return turned;
        const auto end = text_.find('\'', at_);
        if (end == text_.npos) fail("a ' is missing");
        const std::string group(text_.substr(at_, end - at_));
        at_ = end + 1;
        if (std::find(groups_.begin(), groups_.end(), group) == groups_.end()) groups_.push_back(group);
        return group == group_ ? turned : std::string(no_path);
    }

    [[noreturn]] void refuse(char c) const {
        if (c == 'R' || c == 'T') fail("operators do not tell reflection from transmission: write <.D> or <.S>");
        if (c == 'G') fail("operators do not tell glossy from diffuse, D is both: anything rougher than a mirror");
        if (!c) fail("something is missing");
        fail("unknown here: C, then D, S, V or ., then L, O or B");
    }

    std::string_view text_;
    const std::string& group_;
    Collisions collisions_;
    std::vector<std::string> groups_;
    std::size_t at_ = 0;
    int nesting_ = 0;
};

PathExpression::PathExpression(std::string text) : text_(std::move(text)) {
    const std::string none;
    Parser parser(text_, none, Collisions::apart);
    names_collisions_ = parser.whole().find('V') != std::string::npos;
    groups_ = parser.groups();
}

PathSet PathExpression::of(const std::string& group, Collisions collisions) const {
    return PathSet::parse(Parser(text_, group, collisions).whole());
}

}  // namespace lightnet
