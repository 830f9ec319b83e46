// Counts the members of classes: what a reader has to hold in the head.
#include <algorithm>
#include <cctype>
#include <map>
#include <set>
#include <utility>

#include "tests/architecture/rules.hpp"

namespace lightnet::house {
namespace {

/// The members of one class, read from the text between its braces. Functions, data and constructors count, one for
/// each declaration; types within it, aliases, friends and what is defaulted or deleted do not.
class Members {
public:
    explicit Members(std::string_view body) {
        for (const char c : body) step(c);
        if (ended_body_ && is_function_with_body(' ')) end();
    }
    std::size_t count() const { return count_; }

private:
    void step(char c) {
        if (c == '{' && parentheses_ == 0) {
            if (braces_++ == 0) seen_ += " {} ";
        } else if (c == '}' && parentheses_ == 0) {
            if (--braces_ == 0) ended_body_ = true;
        } else if (braces_ == 0) {
            outside(c);
        }
    }
    void outside(char c) {
        if (std::exchange(ended_body_, ended_body_ && std::isspace(static_cast<unsigned char>(c))) &&
            !std::isspace(static_cast<unsigned char>(c)) && is_function_with_body(c))
            end();
        parentheses_ += (c == '(') - (c == ')');
        if (c == ';' && parentheses_ == 0)
            end();
        else
            seen_ += c;
    }
    // A body is followed by the next member; an initialiser, or a nested type, by a semicolon, a comma or a name.
    bool is_function_with_body(char next) const {
        return seen_.find('(') != std::string::npos && next != ';' && next != ',' && next != '{' && !is_type();
    }
    bool is_type() const {
        const auto words = words_of_declaration();
        for (const auto& word : words) {
            if (word == "struct" || word == "class" || word == "union" || word == "enum") return true;
            if (word != "template" && word != "alignas") return false;
        }
        return false;
    }
    // Without access specifiers and what stands in angle brackets.
    std::vector<std::string> words_of_declaration() const {
        std::vector<std::string> words;
        int angles = 0;
        std::string word;
        for (const char c : seen_ + " ") {
            angles += (c == '<') - (c == '>' && angles > 0);
            if (angles == 0 && (std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '~')) {
                word += c;
                continue;
            }
            const bool access = c == ':' && (word == "public" || word == "private" || word == "protected");
            if (!word.empty() && !access) words.push_back(word);
            word.clear();
        }
        return words;
    }
    void end() {
        const auto words = words_of_declaration();
        static const std::set<std::string> of_no_weight{"using", "friend", "static_assert", "typedef"};
        const auto body = seen_.rfind("{}");
        const bool names_nothing =
            body == std::string::npos || seen_.find_first_not_of(" \n", body + 2) == std::string::npos;
        const bool given = seen_.find("= default") != std::string::npos || seen_.find("= delete") != std::string::npos;
        count_ += !words.empty() && !of_no_weight.contains(words.front()) && !(is_type() && names_nothing) && !given;
        seen_.clear();
    }

    std::string seen_;  // of this declaration, without what stands in braces
    int braces_ = 0, parentheses_ = 0;
    bool ended_body_ = false;
    std::size_t count_ = 0;
};

/// Where a class begins: its name, and the place behind its opening brace.
struct Beginning {
    std::string name;
    std::size_t body, line;
};

bool is_letter(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

std::vector<Beginning> classes_in(const std::string& code) {
    std::vector<Beginning> found;
    for (std::size_t at = 0; at < code.size(); ++at) {
        const bool begins = at == 0 || !is_letter(code[at - 1]);
        const std::size_t length = code.compare(at, 6, "struct") == 0 ? 6 : code.compare(at, 5, "class") == 0 ? 5 : 0;
        if (!begins || length == 0 || is_letter(code[at + length])) continue;
        const std::size_t brace = code.find_first_of("{;(=>", at);
        if (brace == std::string::npos || code[brace] != '{' || code.compare(at > 5 ? at - 5 : 0, 4, "enum") == 0)
            continue;
        std::string head = code.substr(at + length, brace - at - length);
        for (std::size_t colon = head.find(':'); colon != std::string::npos; colon = head.find(':', colon + 1)) {
            if (head[colon + 1] == ':') {
                ++colon;
                continue;
            }
            head.resize(colon);
            break;
        }
        std::string name;
        for (const char c : head)
            if (is_letter(c) || c == ':')
                name += c;
            else if (name == "final")
                name.clear();
            else if (!name.empty())
                break;
        const auto line = 1 + static_cast<std::size_t>(std::count(code.begin(), code.begin() + long(at), '\n'));
        if (!name.empty()) found.push_back({name, brace + 1, line});
    }
    return found;
}

std::size_t end_of_body(const std::string& code, std::size_t at) {
    int open = 1;
    for (; at < code.size() && open > 0; ++at) open += (code[at] == '{') - (code[at] == '}');
    return at - 1;
}

}  // namespace

std::vector<ClassSize> class_sizes(const SourceFile& file) {
    const std::string code = code_only(file.text);
    std::vector<ClassSize> sizes;
    for (const auto& [name, body, line] : classes_in(code)) {
        const Members members(std::string_view(code).substr(body, end_of_body(code, body) - body));
        sizes.push_back({name, file.path, line, members.count()});
    }
    return sizes;
}

Complaints too_large(const std::vector<SourceFile>& files, std::size_t most,
                     const std::map<std::string, std::size_t>& debts) {
    Complaints complaints;
    auto unpaid = debts;
    for (const SourceFile& file : files)
        for (const auto& [name, path, line, members] : class_sizes(file)) {
            const auto debt = debts.find(path + " " + name);
            const std::size_t allowed = debt == debts.end() ? most : debt->second;
            if (debt != debts.end() && members > most) unpaid.erase(debt->first);
            if (members > allowed)
                complaints.push_back(path + ":" + std::to_string(line) + ": " + name + " has " +
                                     std::to_string(members) + " members, and " + std::to_string(allowed) +
                                     " are allowed");
            else if (debt != debts.end() && members > most && members < allowed)
                complaints.push_back("the debt of " + debt->first + " falls to " + std::to_string(members));
        }
    for (const auto& [name, size] : unpaid) complaints.push_back("the debt of " + name + " is paid: its line goes");
    return complaints;
}

}  // namespace lightnet::house
