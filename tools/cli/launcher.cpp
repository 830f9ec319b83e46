#include "tools/cli/launcher.hpp"

#include <CLI/CLI.hpp>

#include <algorithm>
#include <optional>
#include <ostream>

#include "core/base/build_info.hpp"
#include "core/base/joined.hpp"
#include "core/base/suggestion.hpp"
#include "core/base/words_of.hpp"
#include "core/readers/read_scene.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

/// The grammar of the command line. Actions fill in when a line is taken apart, and outlive the grammar.
class Grammar {
public:
    explicit Grammar(const std::vector<Verb>& verbs)
        : app_("A lighting network: one graph, serial, threaded or networked, the same picture.", "lightnet") {
        app_.set_version_flag("--version", "lightnet " + version());
        app_.require_subcommand(1);
        app_.footer(
            "exit codes: 0 done, 1 the run failed (or pictures are too far apart), 2 usage, graph or scene error,\n"
            "3 no worker reachable, 4 none whose key is known and that knows ours, 5 hosts of another build, 130 "
            "interrupted\n\nExamples:\n  "
            "lightnet run graphs/cornell.lua\n"
            "  lightnet help run");
        for (const auto& verb : verbs) {
            CLI::App& app = *app_.add_subcommand(verb.name, verb.help);
            known_.push_back({verb.name, verb.options(app)});
            add_everywhere(app, *plugins_);
        }
        app_.add_subcommand("help", "show how a verb is used: lightnet help run");
    }

    std::variant<Action, Finished> parse(std::vector<std::string> words) {
        if (!words.empty() && words[0] == "help") words = help_words(words);
        if (auto unknown = unknown_verb(words)) return *unknown;
        if (auto finished = take_apart(app_, words)) return *finished;
        const auto chosen = std::find_if(known_.begin(), known_.end(),
                                         [&](const auto& verb) { return app_.got_subcommand(verb.name); });
        if (chosen == known_.end()) return Finished{exit_code::done, app_.help(), ""};
        return [plugins = plugins_, action = chosen->action](const Launcher& launcher) {
            if (launcher.plug) launcher.plug(*plugins);
            return action(launcher);
        };
    }

    std::vector<VerbText> texts() const { return texts_of(app_); }

private:
    struct Known {
        std::string name;
        Action action;
    };

    // "help run" is "run --help".
    static std::vector<std::string> help_words(std::vector<std::string> words) {
        words.erase(words.begin());
        if (!words.empty() && words[0] == "help") words.clear();
        words.push_back("--help");
        return words;
    }

    // The library would only say that a verb is missing.
    std::optional<Finished> unknown_verb(const std::vector<std::string>& words) const {
        if (words.empty()) return Finished{exit_code::usage, "", app_.help()};
        const auto& word = words[0];
        if (word.starts_with('-')) return std::nullopt;
        std::vector<std::string> names{"help"};
        for (const auto& verb : known_) names.push_back(verb.name);
        if (std::find(names.begin(), names.end(), word) != names.end()) return std::nullopt;
        if (word.ends_with(".lua"))
            return usage_error(app_, "'" + word + "' is a graph file; to render it: lightnet run " + word);
        if (is_named_like_a_scene(word))
            return usage_error(app_, "'" + word + "' is a scene file; to render it: lightnet render " + word);
        return usage_error(app_, "there is no verb '" + word + "'" + did_you_mean(word, names));
    }

    CLI::App app_;
    std::vector<Known> known_;
    std::shared_ptr<std::vector<std::string>> plugins_ = std::make_shared<std::vector<std::string>>();
};

std::ptrdiff_t words_in(const std::string& name) { return std::count(name.begin(), name.end(), ' ') + 1; }

// Whose options the command line gives: "scene info" rather than "scene".
const VerbText* verb_of(const std::vector<VerbText>& texts, const std::vector<std::string>& arguments) {
    const VerbText* best = nullptr;
    std::string name = "lightnet";
    for (const auto& word : arguments) {
        name += " " + word;
        for (const auto& text : texts)
            if (text.name == name) best = &text;
    }
    return best;
}

}  // namespace

std::variant<Action, Finished> understand(const std::vector<std::string>& arguments, const std::vector<Verb>& verbs) {
    return Grammar(verbs).parse(arguments);
}

std::vector<VerbText> launcher_texts(const std::vector<Verb>& verbs) { return Grammar(verbs).texts(); }

int Launcher::perform(const std::vector<std::string>& arguments) const {
    const auto texts = launcher_texts(verbs);
    const VerbText* const verb = verb_of(texts, arguments);
    auto words = arguments;
    std::vector<std::string> more;
    if (verb && std::find(words.begin(), words.end(), "--print-config") != words.end()) {
        out << settings_table(settings.settled(*verb, words));
        return exit_code::done;
    }
    if (verb) more = settings.missing(*verb, words);
    if (verb) words.insert(words.begin() + words_in(verb->name) - 1, more.begin(), more.end());
    const auto understood = understand(words, verbs);
    if (const auto* finished = std::get_if<Finished>(&understood)) {
        out << finished->out;
        err << finished->err;
        if (finished->code == exit_code::usage && !more.empty())
            err << "settled elsewhere (--print-config): " << joined(more, " ") << '\n';
        return finished->code;
    }
    return std::get<Action>(understood)(*this);
}

int Launcher::operator()(const std::vector<std::string>& arguments) const {
    try {
        return perform(arguments);
    } catch (const UserError& error) {
        err << error.what() << '\n';
        return exit_code::usage;
    } catch (const std::bad_alloc&) {
        err << "lightnet: there is not enough memory for what was asked of '"
            << (arguments.empty() ? "" : arguments.front()) << "'\n";
        return exit_code::failed;
    } catch (const std::exception& error) {
        err << "lightnet: " << words_of(error) << '\n';
        return exit_code::failed;
    }
}

}  // namespace lightnet
