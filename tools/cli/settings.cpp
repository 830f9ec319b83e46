#include "tools/cli/settings.hpp"

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <filesystem>
#include <set>

#include "core/base/suggestion.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/daemon/daemon_options.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

constexpr const char* daemon_table = "lightnetd";

// Those that are questions, or belong to one command line alone.
bool may_be_settled(const OptionText& option) {
    static const std::set<std::string> never{"--help", "--version", "--print-config", "--all"};
    return !option.word && option.names.back().starts_with("--") && !never.contains(option.names.back());
}

// "--local-workers" → "local_workers"
std::string setting_name(const std::string& flag) {
    std::string name = flag.substr(2);
    std::replace(name.begin(), name.end(), '-', '_');
    return name;
}

std::string upper_case(std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::toupper(c); });
    return text;
}

// The value that the words give an option; the last counts.
std::optional<std::string> value_in(const std::vector<std::string>& words, const OptionText& option) {
    std::optional<std::string> value;
    for (std::size_t i = 0; i < words.size(); ++i)
        for (const auto& name : option.names) {
            const bool is_long = name.starts_with("--");
            if (words[i] == name)
                value = option.value.empty() ? "true" : i + 1 < words.size() ? words[i + 1] : "";
            else if (is_long ? words[i].starts_with(name + "=")
                             : words[i].starts_with(name) && !words[i].starts_with("--"))
                value = words[i].substr(name.size() + is_long);
        }
    return value;
}

// "run" of "lightnet run"
std::string verb_name(const VerbText& verb) {
    const auto space = verb.name.find(' ');
    return space == std::string::npos ? "" : verb.name.substr(space + 1);
}

std::optional<std::string> of_environment(const std::string& name) {
    const char* const value = std::getenv(name.c_str());
    return value && *value ? std::optional<std::string>(value) : std::nullopt;
}

std::set<std::string> setting_names(const std::vector<VerbText>& texts, const std::string& verb) {
    std::set<std::string> names;
    for (const auto& text : texts)
        if (verb.empty() || verb_name(text) == verb)
            for (const auto& option : text.options)
                if (may_be_settled(option)) names.insert(setting_name(option.names.back()));
    return names;
}

// Lines that nobody will ever read are mistakes.
void check_lines(const std::vector<SettingLine>& lines) {
    const auto launcher = launcher_texts(standard_verbs()), daemon = daemon_texts();
    std::vector<Problem> problems;
    for (const auto& line : lines) {
        const auto known = line.verb == daemon_table ? setting_names(daemon, "") : setting_names(launcher, line.verb);
        if (known.contains(line.name)) continue;
        if (known.empty())
            problems.push_back({line.where, "there is no verb '" + line.verb + "'"});
        else
            problems.push_back({line.where, "no option is called '" + line.name + "'" +
                                                did_you_mean(line.name, {known.begin(), known.end()})});
    }
    if (!problems.empty()) throw UserError(std::move(problems));
}

std::vector<SettingLine> lines_of_user() {
    const auto file = settings_file();
    std::error_code none;
    if (file.empty() || !fs::exists(file, none)) return {};
    auto lines = load_settings(file);
    check_lines(lines);
    for (auto& line : lines)  // a hosts file beside it
        if (line.name == "hosts" && !line.value.empty())
            line.value = (fs::path(file).parent_path() / line.value).lexically_normal();
    return lines;
}

}  // namespace

std::vector<Settled> Settings::settled(const VerbText& verb, const std::vector<std::string>& words) const {
    std::vector<Settled> all;
    for (const auto& option : verb.options) {
        if (!may_be_settled(option)) continue;
        const auto& flag = option.names.back();
        const auto name = setting_name(flag), of_shell = prefix + upper_case(name);
        if (const auto said = value_in(words, option)) {
            all.push_back({flag, *said, "command line"});
            continue;
        }
        if (const auto said = variable ? variable(of_shell) : std::nullopt) {
            all.push_back({flag, *said, of_shell});
            continue;
        }
        const SettingLine* best = nullptr;  // a verb's own table before what is for all
        for (const auto& line : lines)
            if (line.name == name && (line.verb == verb_name(verb) || (line.verb.empty() && !best))) best = &line;
        if (best)
            all.push_back({flag, best->value, best->where.file + ":" + std::to_string(best->where.line)});
        else
            all.push_back({flag, option.initial, "built in"});
    }
    return all;
}

std::vector<std::string> Settings::missing(const VerbText& verb, const std::vector<std::string>& words) const {
    const auto all = settled(verb, words);
    const auto is_said = [&](const std::string& flag) {
        return std::any_of(all.begin(), all.end(),
                           [&](const Settled& one) { return one.option == flag && one.source != "built in"; });
    };
    std::vector<std::string> more;
    for (const auto& one : all) {
        if (one.source == "command line" || one.source == "built in") continue;
        const auto option = std::find_if(verb.options.begin(), verb.options.end(),
                                         [&](const OptionText& known) { return known.names.back() == one.option; });
        if (std::all_of(option->needs.begin(), option->needs.end(), is_said))
            more.push_back(one.option + "=" + one.value);
    }
    return more;
}

std::string settings_file() {
    if (const auto named = of_environment("LIGHTNET_CONFIG")) return *named;
    if (const auto config = of_environment("XDG_CONFIG_HOME")) return fs::path(*config) / "lightnet/config.lua";
    const auto home = of_environment("HOME");
    return home ? fs::path(*home) / ".config/lightnet/config.lua" : fs::path();
}

Settings settings_of_launcher() {
    auto lines = lines_of_user();
    std::erase_if(lines, [](const SettingLine& line) { return line.verb == daemon_table; });
    return {"LIGHTNET_", std::move(lines), of_environment};
}

Settings settings_of_daemon() {
    auto lines = lines_of_user();
    std::erase_if(lines, [](const SettingLine& line) { return line.verb != daemon_table; });
    for (auto& line : lines) line.verb.clear();
    return {"LIGHTNETD_", std::move(lines), of_environment};
}

std::string settings_table(const std::vector<Settled>& all) {
    std::size_t names = 0, values = 0;
    for (const auto& one : all) names = std::max(names, one.option.size()), values = std::max(values, one.value.size());
    std::string text;
    for (const auto& one : all)
        text += one.option + std::string(names + 2 - one.option.size(), ' ') + one.value +
                std::string(values + 2 - one.value.size(), ' ') + one.source + "\n";
    return text;
}

}  // namespace lightnet
