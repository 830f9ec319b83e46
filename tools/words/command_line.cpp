#include "tools/words/command_line.hpp"

#include <fmt/format.h>
#include <CLI/CLI.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <sstream>
#include <utility>

#include "core/base/ip_address.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "tools/support/exit_code.hpp"

namespace lightnet {
namespace {

const CLI::App& chosen_in(const CLI::App& app) {
    const auto verbs = app.get_subcommands();
    return verbs.empty() ? app : chosen_in(*verbs.front());
}

// "lightnet scene info"
std::string full_name(const CLI::App& app) {
    return app.get_parent() ? full_name(*app.get_parent()) + " " + app.get_name() : app.get_name();
}

const CLI::App& root_of(const CLI::App& app) { return app.get_parent() ? root_of(*app.get_parent()) : app; }

std::vector<std::string> flags_of(const CLI::App& app) {
    std::vector<std::string> names;
    for (const auto* option : app.get_options()) {
        for (const auto& name : option->get_lnames()) names.push_back("--" + name);
        for (const auto& name : option->get_snames()) names.push_back("-" + name);
    }
    return names;
}

bool contains(const std::vector<std::string>& names, const std::string& name) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

// "-5" may be a value; "-Dname=value" is a flag with one.
bool is_flag(const std::string& word) {
    return word.size() > 1 && word[0] == '-' && !std::isdigit(static_cast<unsigned char>(word[1])) && word != "--";
}

std::string flag_in(const std::string& word) {
    return word.starts_with("--") ? word.substr(0, word.find('=')) : word.substr(0, 2);
}

// What is wrong with the first flag that nobody knows; none: all are known.
std::optional<std::string> unknown_flag(const CLI::App& verb, const std::vector<std::string>& words) {
    const auto known = flags_of(verb);
    for (const auto& word : words) {
        if (!is_flag(word)) continue;
        const auto flag = flag_in(word);
        if (!contains(known, flag)) return "there is no option '" + flag + "'" + did_you_mean(flag, known);
    }
    return std::nullopt;
}

// A word that is left over, though it may be known.
std::string unexpected_word(const CLI::App& app, const CLI::App& verb) {
    const auto left = app.remaining(true);
    if (left.empty()) return "there is a word too many";
    if (&verb != &app && is_flag(left.front()) && contains(flags_of(verb), flag_in(left.front())))
        return "'" + left.front() + "' stands after the verb: " + full_name(verb) + " " + left.front();
    return "what is '" + left.front() + "' for?";
}

// Which verb of a verb is meant, where that is what lacks; else what the library says.
std::string missing(const CLI::App& app, const std::string& said) {
    const CLI::App& verb = chosen_in(app);
    std::vector<std::string> known;
    std::string all;
    for (const auto* one : verb.get_subcommands([](const CLI::App*) { return true; })) {
        known.push_back(one->get_name());
        all += " " + one->get_name();
    }
    if (known.empty()) return said;
    const auto left = app.remaining(true);
    if (left.empty()) return "'" + full_name(verb) + "' wants one of these behind it:" + all;
    return "there is no '" + full_name(verb) + " " + left.front() + "'" + did_you_mean(left.front(), known);
}

// As with most programs, so that scripts can append to a command line that somebody else has begun.
void let_the_last_win(CLI::App& app) {
    for (auto* const option : app.get_options([](const CLI::Option* one) { return !one->get_positional(); }))
        if (option->get_multi_option_policy() == CLI::MultiOptionPolicy::Throw && option->get_items_expected_max() == 1)
            option->multi_option_policy(CLI::MultiOptionPolicy::TakeLast);
    for (auto* const verb : app.get_subcommands([](const CLI::App*) { return true; })) let_the_last_win(*verb);
}

}  // namespace

Finished usage_error(const CLI::App& app, const std::string& what) {
    const CLI::App& verb = chosen_in(app);
    return {exit_code::usage, "", root_of(app).get_name() + ": " + what + "\ntry: " + full_name(verb) + " --help\n"};
}

std::optional<Finished> take_apart(CLI::App& app, const std::vector<std::string>& arguments) {
    let_the_last_win(app);
    std::vector<std::string> backwards(arguments.rbegin(), arguments.rend());  // as the library wants them
    try {
        app.parse(backwards);
        return std::nullopt;
    } catch (const CLI::Success& done) {
        std::ostringstream out, err;
        app.exit(done, out, err);
        return Finished{exit_code::done, out.str(), err.str()};
    } catch (const CLI::ExtrasError&) {
        const CLI::App& verb = chosen_in(app);
        const auto unknown = unknown_flag(verb, arguments);
        return usage_error(app, unknown ? *unknown : unexpected_word(app, verb));
    } catch (const CLI::RequiredError& error) {  // perhaps for want of a flag that was mistyped
        const auto unknown = unknown_flag(chosen_in(app), arguments);
        return usage_error(app, unknown ? *unknown : missing(app, error.what()));
    } catch (const CLI::ParseError& error) {
        return usage_error(app, error.what());
    }
}

void when_taken_apart(CLI::App& app, std::function<std::optional<std::string>()> mistake) {
    app.callback([mistake = std::move(mistake)] {
        if (const auto what = mistake()) throw CLI::ValidationError(*what);
    });
}

void add_examples(CLI::App& app, const std::vector<std::string>& lines) {
    std::string text = lines.size() == 1 ? "Example:" : "Examples:";
    for (const auto& line : lines) text += "\n  " + line;
    app.footer(text);
}

void add_everywhere(CLI::App& app, std::vector<std::string>& plugins) {
    app.add_flag("--print-config")
        ->description(
            "tell the value of each option, and whether the command line, the environment or "
            "~/.config/lightnet/config.lua says so")
        ->group("Everywhere");
    app.add_option("--plugin", plugins,
                   "shared library that brings kinds of nodes or formats of scenes (may be repeated)")
        ->type_name("FILE")
        ->expected(1)
        ->allow_extra_args(false)
        ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll)
        ->delimiter(':')
        ->group("Everywhere");
}

CLI::Option* takes_numbers(CLI::Option* option, const char* unit, std::uint64_t least, std::uint64_t most) {
    return option->type_name(unit)->check([least, most](const std::string& text) -> std::string {
        std::uint64_t number = 0;
        const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
        if (fault == std::errc{} && end == text.data() + text.size() && number >= least && number <= most) return {};
        return fmt::format("must be a whole number from {} to {}, not '{}'", least, most, text);
    });
}

std::optional<double> amount_of(const std::string& text) {
    double number = 0;
    const auto [end, fault] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (fault != std::errc{} || end != text.data() + text.size() || !std::isfinite(number)) return std::nullopt;
    return number;
}

CLI::Option* takes_amounts(CLI::Option* option, const char* unit, Least least) {
    return option->type_name(unit)->check([least](const std::string& text) -> std::string {
        const auto number = amount_of(text);
        if (number && (*number > 0 || (*number == 0 && least == Least::zero))) return {};
        return fmt::format("must be a number {}, not '{}'", least == Least::zero ? "of 0 or more" : "above 0", text);
    });
}

CLI::Option* takes_one_of(CLI::Option* option, const std::vector<std::string>& words) {
    return option->type_name(joined(words, "|"))->check([words](const std::string& text) -> std::string {
        if (std::find(words.begin(), words.end(), text) != words.end()) return {};
        return "must be " + joined(words, ", ") + ", not '" + text + "'" + did_you_mean(text, words);
    });
}

CLI::Option* takes_endpoint(CLI::Option* option, bool listens) {
    return option->type_name("tcp://HOST:PORT")->check([listens](std::string text) -> std::string {
        const std::string typed = text;
        if (listens && (text.ends_with(":*") || text.ends_with(":0"))) text.replace(text.size() - 1, 1, "1");
        if (listens && text.starts_with("tcp://*:")) text.replace(6, 1, "0.0.0.0");
        const auto address = address_of(text);
        if (address && !is_mistaken_number(address->host)) return {};
        return "must be like tcp://" +
               std::string(listens ? "127.0.0.1:7777, tcp://[::1]:7777 or tcp://0.0.0.0:*"
                                   : "10.0.0.11:7777 or tcp://[fd00::11]:7777") +
               ", not '" + typed + "'";
    });
}

}  // namespace lightnet
