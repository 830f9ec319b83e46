// A program's command line as text: what manual pages, completions of shells and the reference are made from, so that
// none of them can say anything but what the program takes.
#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace lightnet {

struct OptionText {
    std::vector<std::string> names;  // "-o", "--output"; a word without a flag has one name: "GRAPH"
    std::string value;               // "SECONDS", "auto|bar|none"; "": takes none
    std::string help;
    std::string group;    // "OPTIONS", "Tuning"
    std::string initial;  // the default, if it is a fixed one
    bool word = false;    // of the command line, without a flag
    bool required = false;
    std::vector<std::string> needs = {};  // options without which it means nothing
};

/// A program, or one of its verbs.
struct VerbText {
    std::string name;  // "lightnet run"
    std::string help;
    std::string footer;  // examples
    std::vector<OptionText> options;
    std::vector<std::string> verbs;  // of this one, by their last word
};

/// `app` and all verbs below it, each before its own.
std::vector<VerbText> texts_of(const CLI::App& app);

/// "lightnet-run": its manual page, and the file's name.
std::string page_name(const VerbText& verb);
/// A manual page of section 1.
std::string manual_page(const VerbText& verb);
/// A page of the reference.
std::string markdown_page(const VerbText& verb);

/// Completion scripts for a program: of its texts, the program first.
std::string bash_completion(const std::vector<VerbText>& program);
std::string zsh_completion(const std::vector<VerbText>& program);
std::string fish_completion(const std::vector<VerbText>& program);

}  // namespace lightnet
