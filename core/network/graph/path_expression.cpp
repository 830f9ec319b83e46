#include "core/network/graph/path_expression.hpp"

#include <algorithm>
#include <cctype>

#include "core/base/error.hpp"
#include "core/base/in_quotes.hpp"

namespace lightnet {
namespace {

constexpr std::string_view no_path = "(EL)";  // no light comes behind an eye

constexpr std::size_t most_length = 1024;
constexpr int most_nesting = 32;

}  // namespace

/// Recursive descent, which puts the last thing of each sequence first.
class PathExpression::Parser {
public:
    Parser(std::string_view text, std::vector<std::string>& groups) : text_(text), groups_(groups) {}

    std::string whole() {
        if (text_.size() > most_length) fail("it is too long");
        std::string turned = alternatives();
        if (at_ != text_.size()) fail("this closes nothing");
        return turned;
    }

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

    std::string alternatives() {
        if (++nesting_ > most_nesting) fail("it is nested too deeply");
        std::string all = "(" + sequence();
        while (take('|')) all += "|" + sequence();
        --nesting_;
        return all + ")";
    }

    std::string sequence() {
        std::string turned;
        while (!next_is('|') && !next_is(')') && at_ < text_.size()) {
            std::string one = atom();
            one += repetition();
            turned = one + turned;
        }
        return turned;
    }

    // As it stands, up to its end: what it counts is the same in both directions.
    std::string repetition() {
        std::string all;
        for (;;) {
            if (next_is('*') || next_is('+') || next_is('?')) {
                all += letter();
            } else if (next_is('{')) {
                const auto end = text_.find('}', at_);
                if (end == text_.npos) fail("no } follows");
                all += text_.substr(at_, end + 1 - at_);
                at_ = end + 1;
            } else {
                return all;
            }
        }
    }

    std::string atom() {
        if (take('(')) {
            std::string some = alternatives();
            if (!take(')')) fail("a ) is missing");
            return some;
        }
        if (take('[')) return any_of();
        if (take('<')) return event();
        const char c = letter();
        if (c == 'C') return "E";
        if (c == '.') return "(S|D)";
        if (c == 'D' || c == 'S') return std::string(1, c);
        if (c == 'L' || c == 'O' || c == 'B') return light(c);
        --at_;
        refuse(c);
    }

    std::string any_of() {
        if (next_is('^')) fail("sets of what is not meant are not known here: name what is");
        std::string all = "(" + atom();
        while (!take(']')) {
            if (at_ >= text_.size()) fail("a ] is missing");
            all += "|" + atom();
        }
        return all + ")";
    }

    // <.D>, <L.'key'>: what happens, how, and a label.
    std::string event() {
        const char what = letter();
        std::string turned;
        if (what == 'L' || what == 'O' || what == 'B') {
            if (!take('.')) fail("a light is written <L.> or <L.'group'>");
            turned = light(what);
        } else {
            if (what != '.') --at_, refuse(what);
            const char how = letter();
            if (how == 'D' || how == 'S')
                turned = std::string(1, how);
            else if (how == '.')
                turned = "(S|D)";
            else
                --at_, refuse(how);
        }
        if (!take('>')) fail("a > is missing");
        return turned;
    }

    std::string light(char which) {
        const std::string turned(1, which == 'O' ? 'A' : which == 'B' ? 'V' : 'L');
        if (!take('\'')) return turned;
        const auto end = text_.find('\'', at_);
        if (end == text_.npos) fail("a ' is missing");
        const std::string group(text_.substr(at_, end - at_));
        at_ = end + 1;
        auto known = std::find(groups_.begin(), groups_.end(), group);
        if (known == groups_.end()) known = groups_.insert(known, group);
        return "(" + turned + std::to_string(known - groups_.begin()) + "#)";
    }

    [[noreturn]] void refuse(char c) const {
        if (c == 'R' || c == 'T') fail("operators do not tell reflection from transmission: write <.D> or <.S>");
        if (c == 'G') fail("operators do not tell glossy from diffuse, D is both: anything rougher than a mirror");
        if (c == 'V') fail("there are no media that scatter");
        if (!c) fail("something is missing");
        fail("unknown here: C, then D, S or ., then L, O or B");
    }

    std::string_view text_;
    std::vector<std::string>& groups_;
    std::size_t at_ = 0;
    int nesting_ = 0;
};

PathExpression::PathExpression(std::string_view text) : turned_(Parser(text, groups_).whole()) {
    try {
        of("");
    } catch (const Error&) {
        throw Error(in_quotes(std::string(text)) + " is no light path expression: see what is in its { }");
    }
}

PathSet PathExpression::of(const std::string& group) const {
    std::string text;
    for (std::size_t at = 0; at < turned_.size(); ++at) {
        // a light of a group: "A3#"
        const std::size_t mark = turned_.find_first_not_of("0123456789", at + 1);
        const bool light = turned_[at] == 'L' || turned_[at] == 'A' || turned_[at] == 'V';
        if (light && mark != turned_.npos && turned_[mark] == '#') {
            const auto which = std::stoul(turned_.substr(at + 1, mark - at - 1));
            text += groups_[which] == group ? std::string(1, turned_[at]) : std::string(no_path);
            at = mark;
        } else {
            text += turned_[at];
        }
    }
    return PathSet::parse(text);
}

}  // namespace lightnet
