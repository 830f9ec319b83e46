#include "tests/architecture/documents.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <map>
#include <optional>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

namespace lightnet::house {
namespace {

/// An entry of the notebook as its heading and its text have it.
struct Entry {
    const SourceFile* page = nullptr;
    std::size_t line = 0;
    std::string cited_in;  // folder; "": it doesn't say
};

/// Keys with the lines in which a file cites them.
std::vector<std::pair<std::string, std::size_t>> cited_in(const SourceFile& file) {
    static const std::regex citation(R"((//|#) DECISIONS: ([a-z0-9-]+)\s*$)");
    std::vector<std::pair<std::string, std::size_t>> found;
    const auto lines = lines_of(file.text);
    std::smatch match;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (lines[i].find("DECISIONS: ") != std::string::npos && std::regex_search(lines[i], match, citation))
            found.push_back({match[2], i + 1});
    return found;
}

void read_entries(const SourceFile& page, std::map<std::string, Entry>& entries, Complaints& complaints) {
    static const std::regex heading("## ([a-z0-9-]+)"), claim(R"(\*Cited in\* `([\w/]+)`)");
    const auto lines = lines_of(page.text);
    std::string key;
    std::smatch match;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        const std::string two = lines[i] + (i + 1 < lines.size() ? " " + lines[i + 1] : "");  // claims may be wrapped
        if (std::regex_match(lines[i], match, heading)) {
            key = match[1];
            if (!entries.emplace(key, Entry{&page, i + 1, {}}).second)
                complaints.push_back(at_line(page, i + 1, "'" + key + "' is a key already"));
        } else if (!key.empty() && std::regex_search(two, match, claim)) {
            entries[key].cited_in = match[1];
        }
    }
}

std::map<std::string, Entry> entries_of(const Pages& notebook, Complaints& complaints) {
    std::map<std::string, Entry> entries;
    for (const SourceFile& page : notebook) read_entries(page, entries, complaints);
    return entries;
}

/// What the code defines, by name.
struct Vocabulary {
    std::set<std::string> paths, types, words;
};

bool in_word(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

Vocabulary vocabulary_of(const std::vector<SourceFile>& files) {
    static const std::set<std::string> introducing{"class", "struct", "union", "using", "concept"};
    Vocabulary known;
    for (const SourceFile& file : files) {
        known.paths.insert(file.path);
        const std::string code = code_only(file.text);
        std::string before;
        for (auto begin = code.begin(); begin != code.end();) {
            begin = std::find_if(begin, code.end(), in_word);
            const auto end = std::find_if_not(begin, code.end(), in_word);
            std::string word(begin, end);
            if (word == "nodiscard") word = before;  // [[nodiscard]] stands before the name of a type
            if (introducing.contains(before)) known.types.insert(word);
            known.words.insert(word);
            before = std::move(word);
            begin = end;
        }
    }
    return known;
}

bool has_folder(const Vocabulary& known, const std::string& folder) {
    const auto first = known.paths.lower_bound(folder);
    return first != known.paths.end() && first->starts_with(folder);
}

// True for what is no name of the code at all.
bool is_right(const Vocabulary& known, const std::string& name) {
    static const std::regex path(R"([\w/]+/\w+\.(hpp|cpp|lua))"), folder(R"(([a-z]\w*/)+)"),
        type(R"([A-Z]\w*[a-z]\w*(<[\w, ]*>)?)"), member(R"(([A-Z]\w*)::(\w+)(\(\))?)"), function(R"((\w+)\(\))");
    std::smatch match;
    if (std::regex_match(name, path)) return known.paths.contains(name);
    if (std::regex_match(name, folder)) return has_folder(known, name);
    if (std::regex_match(name, type)) return known.types.contains(name.substr(0, name.find('<')));
    if (std::regex_match(name, match, member)) return known.types.contains(match[1]) && known.words.contains(match[2]);
    if (std::regex_match(name, match, function)) return known.words.contains(match[1]);
    return true;
}

/// The number that stands for # in `words`, wherever lines are broken; none: the words are not there.
std::optional<double> number_in(const std::string& text, const std::string& words) {
    static const std::regex special(R"([.*+?^${}()|\[\]\\])"), blanks(R"(\s+)");
    std::string pattern = std::regex_replace(words, special, R"(\$&)");
    pattern = std::regex_replace(pattern, blanks, R"(\s+)");
    pattern.replace(pattern.find('#'), 1, R"((\d[\d'.]*))");
    std::smatch match;
    if (!std::regex_search(text, match, std::regex(pattern))) return std::nullopt;
    std::string digits = match[1];
    std::erase(digits, '\'');
    return std::stod(digits);
}

// Names behind `services.` in backticks, with their lines.
std::map<std::string, std::size_t> listed_services(const SourceFile& document, const std::string& variable) {
    const std::regex listed("`" + variable + R"(\.(\w+))");
    std::map<std::string, std::size_t> found;
    const auto lines = lines_of(document.text);
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::sregex_iterator at(lines[i].begin(), lines[i].end(), listed), end; at != end; ++at)
            found.emplace((*at)[1], i + 1);
    return found;
}

}  // namespace

Complaints unknown_decisions(const SourceFile& file, const Pages& notebook) {
    const auto cited = cited_in(file);
    if (cited.empty()) return {};
    Complaints complaints;
    const auto known = entries_of(notebook, complaints);
    complaints.clear();  // those are the notebook's own
    for (const auto& [key, line] : cited)
        if (!known.contains(key)) complaints.push_back(at_line(file, line, "there is no decision '" + key + "'"));
    return complaints;
}

Complaints uncited_decisions(const Pages& notebook, const std::vector<SourceFile>& files) {
    Complaints complaints;
    std::map<std::string, std::set<std::string>> places;
    for (const SourceFile& file : files)
        for (const auto& [key, line] : cited_in(file)) places[key].insert(file.path);
    for (const auto& [key, entry] : entries_of(notebook, complaints)) {
        const auto& paths = places[key];
        const auto& folder = entry.cited_in;
        if (folder.empty() && !paths.empty())
            complaints.push_back(at_line(*entry.page, entry.line, "'" + key + "' is cited in " + *paths.begin()));
        if (!folder.empty() &&
            std::none_of(paths.begin(), paths.end(), [&](const auto& path) { return path.starts_with(folder + "/"); }))
            complaints.push_back(at_line(*entry.page, entry.line, "'" + key + "' is not cited in " + folder));
    }
    return complaints;
}

Complaints decisions_without_an_entry(const SourceFile& decisions, const Pages& notebook) {
    static const std::regex heading("### ([a-z0-9-]+)");
    Complaints complaints;
    const auto known = entries_of(notebook, complaints);
    complaints.clear();
    const auto lines = lines_of(decisions.text);
    std::smatch match;
    for (std::size_t i = 0; i < lines.size(); ++i)
        if (std::regex_match(lines[i], match, heading) && !known.contains(match[1]))
            complaints.push_back(at_line(decisions, i + 1, "the notebook has no '" + match[1].str() + "'"));
    return complaints;
}

Complaints unknown_names(const SourceFile& document, const std::vector<SourceFile>& files) {
    static const std::regex quoted("`([^`]+)`");
    const auto known = vocabulary_of(files);
    Complaints complaints;
    const auto lines = lines_of(document.text);
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::sregex_iterator at(lines[i].begin(), lines[i].end(), quoted), end; at != end; ++at)
            if (!is_right(known, (*at)[1]))
                complaints.push_back(at_line(document, i + 1, "the code has no `" + (*at)[1].str() + "`"));
    return complaints;
}

std::string disagreement(const Figure& figure, const SourceFile& document, const SourceFile& file) {
    const auto told = number_in(document.text, figure.words), there = number_in(file.text, figure.code);
    if (!told) return document.path + " says no longer: " + figure.words;
    if (!there) return file.path + " says no longer: " + figure.code;
    if (std::abs(*told - *there * figure.factor) <= 1e-9 * std::abs(*told)) return "";
    std::ostringstream out;
    out << document.path << ": " << figure.words << ": it says " << *told << ", " << file.path << " has "
        << *there * figure.factor;
    return out.str();
}

// As clang-format leaves it: members of a class begin in the fifth column.
Offer offer_of(const SourceFile& header, const std::string& type, const std::string& variable) {
    static const std::regex declaration(R"(^ {4}(?! )(?!static|explicit|template|friend|//).*?[\w>&*] [&*]?(\w+)\(.*)");
    Offer offer{variable, {}};
    bool inside = false, open = false;
    std::smatch match;
    for (const auto& line : lines_of(header.text)) {
        if (line.starts_with("class " + type + " ")) inside = true;
        if (line == "};") inside = false;
        if (line == "public:" || line == "protected:" || line == "private:") open = line == "public:";
        if (inside && open && std::regex_match(line, match, declaration)) offer.functions.push_back(match[1]);
    }
    return offer;
}

Complaints unlisted_services(const SourceFile& document, const Offer& offer) {
    const auto listed = listed_services(document, offer.variable);
    Complaints complaints;
    for (const auto& function : offer.functions)
        if (!listed.contains(function))
            complaints.push_back(document.path + " says nothing of `" + offer.variable + "." + function + "()`");
    return complaints;
}

Complaints idle_services(const SourceFile& document, const Offer& offer, const std::vector<SourceFile>& callers) {
    Complaints complaints;
    for (const auto& [name, line] : listed_services(document, offer.variable)) {
        const std::regex call("\\b" + offer.variable + "_?\\." + name + "\\b");
        if (std::ranges::find(offer.functions, name) == offer.functions.end())
            complaints.push_back(at_line(document, line, "there is no `" + offer.variable + "." + name + "()`"));
        else if (std::ranges::none_of(
                     callers, [&](const SourceFile& file) { return std::regex_search(code_only(file.text), call); }))
            complaints.push_back(at_line(document, line, "no node uses `" + offer.variable + "." + name + "()`"));
    }
    return complaints;
}

Complaints dead_links(const SourceFile& document, bool (*exists)(const std::string& path)) {
    static const std::regex link(R"(\[[^\]]+\]\(([^)#: ]+)(#[^)]*)?\))");
    const auto slash = document.path.rfind('/');
    const std::string folder = slash == std::string::npos ? "" : document.path.substr(0, slash + 1);
    Complaints complaints;
    const auto lines = lines_of(document.text);
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::sregex_iterator at(lines[i].begin(), lines[i].end(), link), end; at != end; ++at)
            if (!exists(folder + (*at)[1].str()))
                complaints.push_back(at_line(document, i + 1, "there is no " + (*at)[1].str()));
    return complaints;
}

}  // namespace lightnet::house
