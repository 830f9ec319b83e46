#include "tools/words/program_text.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <set>

#include "core/base/build_info.hpp"

namespace lightnet {
namespace {

OptionText text_of_option(const CLI::Option& option) {
    OptionText text;
    for (const auto& name : option.get_snames()) text.names.push_back("-" + name);
    for (const auto& name : option.get_lnames()) text.names.push_back("--" + name);
    text.word = text.names.empty();
    if (text.word) text.names.push_back(option.get_name(true));
    if (option.get_items_expected_max() > 0) text.value = option.get_type_name();
    text.help = option.get_description();
    text.group = option.get_group();
    text.initial = option.get_default_str();
    text.required = option.get_required();
    for (const auto* other : option.get_needs()) text.needs.push_back(other->get_name());
    return text;
}

std::string full_name_of(const CLI::App& app) {
    return app.get_parent() ? full_name_of(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

void collect(const CLI::App& app, std::vector<VerbText>& texts) {
    VerbText text{full_name_of(app), app.get_description(), app.get_footer(), {}, {}};
    for (const auto* option : app.get_options())
        if (!option->get_group().empty()) text.options.push_back(text_of_option(*option));
    std::stable_partition(text.options.begin(), text.options.end(), [](const auto& option) { return option.word; });
    const auto below = app.get_subcommands([](const CLI::App*) { return true; });
    for (const auto* verb : below)
        if (verb->get_name() != "help") text.verbs.push_back(verb->get_name());  // which has no page
    texts.push_back(std::move(text));
    for (const auto* verb : below) collect(*verb, texts);
}

std::string replaced(std::string text, const std::string& what, const std::string& with) {
    for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += with.size())
        text.replace(at, what.size(), with);
    return text;
}

// Text of a manual page: nothing in it is an instruction to the typesetter.
std::string roff(std::string text) {
    text = replaced(replaced(std::move(text), "\\", "\\e"), "-", "\\-");
    text = replaced(replaced(std::move(text), "\n.", "\n\\&."), "\n'", "\n\\&'");
    return text.starts_with('.') || text.starts_with('\'') ? "\\&" + text : text;
}

std::string names_text(const OptionText& option, const std::string& between) {
    std::string text;
    for (const auto& name : option.names) text += (text.empty() ? "" : between) + name;
    return text;
}

// "GRAPH", "[WHOM...]", "[OPTIONS]"
std::string words_text(const VerbText& verb) {
    std::string text;
    if (!verb.verbs.empty()) text += " VERB ...";
    for (const auto& option : verb.options)
        if (option.word) text += option.required ? " " + option.names[0] : " [" + option.names[0] + "]";
    return text + " [OPTIONS]";
}

// Groups in the order in which they come.
std::vector<std::string> groups_of(const VerbText& verb) {
    std::vector<std::string> groups;
    for (const auto& option : verb.options)
        if (std::find(groups.begin(), groups.end(), option.group) == groups.end()) groups.push_back(option.group);
    return groups;
}

std::string heading_of(const std::string& group, const OptionText& first) {
    return first.word ? "Words" : group == "Options" || group == "OPTIONS" ? "Options" : group;
}

std::string help_of(const OptionText& option) {
    return option.help + (option.initial.empty() ? "" : " (default: " + option.initial + ")");
}

std::string upper(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

// One section for each group, and words before all.
template <class Begin, class Each>
void each_section(const VerbText& verb, Begin&& begin, Each&& each) {
    for (const auto& group : groups_of(verb)) {
        std::string heading;
        for (const auto& option : verb.options) {
            if (option.group != group) continue;
            if (const auto now = heading_of(group, option); now != heading) begin(heading = now);
            each(option);
        }
    }
}

}  // namespace

std::vector<VerbText> texts_of(const CLI::App& app) {
    std::vector<VerbText> texts;
    collect(app, texts);
    return texts;
}

std::string page_name(const VerbText& verb) { return replaced(verb.name, " ", "-"); }

std::string manual_page(const VerbText& verb) {
    std::string text = ".TH " + upper(page_name(verb)) + " 1 \"\" \"lightnet " + version() + "\"\n";
    text += ".SH NAME\n" + page_name(verb) + " \\- " + roff(verb.help) + "\n";
    text += ".SH SYNOPSIS\n.B " + roff(verb.name) + "\n" + roff(words_text(verb).substr(1)) + "\n";
    each_section(
        verb, [&](const std::string& heading) { text += ".SH " + upper(heading) + "\n"; },
        [&](const OptionText& option) {
            text += ".TP\n\\fB" + roff(names_text(option, ", ")) + "\\fR";
            if (!option.word && !option.value.empty()) text += " \\fI" + roff(option.value) + "\\fR";
            text += "\n" + roff(help_of(option)) + "\n";
        });
    if (!verb.verbs.empty()) {
        text += ".SH VERBS\n";
        for (const auto& name : verb.verbs)
            text += ".TP\n\\fB" + roff(name) + "\\fR\nsee \\fB" + roff(page_name(verb) + "-" + name) + "\\fR(1)\n";
    }
    if (!verb.footer.empty()) text += ".SH EXAMPLES\n.nf\n" + roff(verb.footer) + "\n.fi\n";
    return text;
}

std::string markdown_page(const VerbText& verb) {
    std::string text = "# " + verb.name + "\n\n" + verb.help + "\n\n    " + verb.name + words_text(verb) + "\n";
    each_section(
        verb, [&](const std::string& heading) { text += "\n## " + heading + "\n\n"; },
        [&](const OptionText& option) {
            text += "- `" + names_text(option, "`, `") + "`";
            if (!option.word && !option.value.empty()) text += " `" + option.value + "`";
            text += ": " + help_of(option) + "\n";
        });
    if (!verb.verbs.empty()) {
        text += "\n## Verbs\n\n";
        for (const auto& name : verb.verbs) text += "- [" + name + "](" + page_name(verb) + "-" + name + ".md)\n";
    }
    if (!verb.footer.empty()) text += "\n```text\n" + verb.footer + "\n```\n";
    return text;
}

}  // namespace lightnet
