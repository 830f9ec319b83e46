// Finds the types that a file defines in named namespaces: what all files of a library share, whether they include each
// other or not.
#include <algorithm>
#include <cctype>
#include <map>
#include <optional>
#include <tuple>

#include "tests/architecture/rules.hpp"

namespace lightnet::house {
namespace {

struct Token {
    std::string text;  // a word, or one character
    std::size_t line;
};

std::vector<Token> tokens_of(const std::string& code) {
    const auto letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; };
    std::vector<Token> tokens;
    std::size_t line = 1;
    for (std::size_t i = 0; i < code.size();) {
        std::size_t end = i + 1;
        while (letter(code[i]) && end < code.size() && letter(code[end])) ++end;
        if (!std::isspace(static_cast<unsigned char>(code[i]))) tokens.push_back({code.substr(i, end - i), line});
        line += code[i] == '\n';
        i = end;
    }
    return tokens;
}

struct Type {
    std::string name;  // "lightnet::gltf::At"
    std::size_t line;
};

/// Walks through a file, and knows in which namespace it is.
class Walk {
public:
    explicit Walk(const SourceFile& file) : tokens_(tokens_of(code_only(file.text))) {
        for (; at_ < tokens_.size(); ++at_) step();
    }
    std::vector<Type> types;
    bool balanced() const { return open_.empty() && !closed_too_many_; }

private:
    const std::string& text(std::size_t ahead = 0) const {
        static const std::string none;
        return at_ + ahead < tokens_.size() ? tokens_[at_ + ahead].text : none;
    }

    void step() {
        if (text() == "namespace")
            enter_namespace();
        else if (text() == "{")
            open_.push_back({});
        else if (text() == "}" && open_.empty())
            closed_too_many_ = true;
        else if (text() == "}")
            open_.pop_back();
        else if (text() == "enum" || text() == "union" ||
                 ((text() == "struct" || text() == "class") && !follows_enum()))
            take_type();
    }

    bool follows_enum() const { return at_ > 0 && tokens_[at_ - 1].text == "enum"; }

    // Up to its brace; without one it is an alias or a directive. A nameless one is a scope like that of a function.
    void enter_namespace() {
        std::string name;
        std::size_t end = 1;
        for (; text(end) != "{"; ++end) {
            if (text(end) == ";" || text(end) == "=" || text(end).empty()) return;
            name += text(end);
        }
        at_ += end;
        open_.push_back(name.empty() ? std::nullopt : std::optional(name));
    }

    void take_type() {
        if (std::find(open_.begin(), open_.end(), std::nullopt) != open_.end()) return;
        std::size_t name = 1;
        if (text(name) == "class" || text(name) == "struct") ++name;  // of an enum
        if (text(name) == "[") {                                      // [[an attribute]]
            while (text(name) != "]" && !text(name).empty()) ++name;
            name += 2;
        }
        std::size_t behind = name + 1;
        if (text(behind) == "final") ++behind;
        if (text(behind) != "{" && (text(behind) != ":" || text(behind + 1) == ":")) return;
        while (text(behind) != "{")
            if (const auto& next = text(behind++); next == ";" || next.empty()) return;
        std::string whole;
        for (const auto& scope : open_) whole += *scope + "::";
        types.push_back({whole + text(name), tokens_[at_].line});
    }

    std::vector<Token> tokens_;
    std::size_t at_ = 0;
    std::vector<std::optional<std::string>> open_;  // namespaces by name; none: anything else
    bool closed_too_many_ = false;
};

}  // namespace

Complaints repeated_types(const std::vector<SourceFile>& files) {
    std::map<std::string, std::string> home;
    Complaints complaints;
    for (const SourceFile& file : files) {
        const Walk walk(file);
        if (!walk.balanced()) complaints.push_back(file.path + ": its braces do not pair, so its types are not known");
        for (const auto& [name, line] : walk.types)
            if (const auto [first, added] = home.emplace(name, file.path); !added)
                complaints.push_back(file.path + ":" + std::to_string(line) + ": " + name + " is defined in " +
                                     first->second + ", too");
    }
    return complaints;
}

}  // namespace lightnet::house
