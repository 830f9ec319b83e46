// Completion scripts, for the three shells that people use. Words are completed as file names everywhere, flags and the
// values of flags by what the command line takes.
#include <algorithm>
#include <cctype>
#include <sstream>

#include "tools/words/program_text.hpp"

namespace lightnet {
namespace {

// "auto", "bar", "none" of "auto|bar|none"; none: it is no list of words.
std::vector<std::string> choices_of(const OptionText& option) {
    std::vector<std::string> choices;
    if (option.value.find('|') == std::string::npos) return choices;
    std::istringstream in(option.value);
    for (std::string one; std::getline(in, one, '|');) {
        if (!std::all_of(one.begin(), one.end(), [](unsigned char c) { return std::islower(c) || c == '-'; }))
            return {};
        choices.push_back(one);
    }
    return choices;
}

std::string joined_words(const std::vector<std::string>& words) {
    std::string text;
    for (const auto& word : words) text += (text.empty() ? "" : " ") + word;
    return text;
}

// In single quotes, as shells want it.
std::string quoted(const std::string& text) {
    std::string safe = "'";
    for (const char c : text) safe += c == '\'' ? std::string("'\\''") : std::string(1, c);
    return safe + "'";
}

std::vector<std::string> flags_of_verb(const VerbText& verb) {
    std::vector<std::string> flags;
    for (const auto& option : verb.options)
        if (!option.word) flags.insert(flags.end(), option.names.begin(), option.names.end());
    return flags;
}

// "run" of "lightnet run"; "": the program itself.
std::string verb_words(const VerbText& verb) {
    const auto space = verb.name.find(' ');
    return space == std::string::npos ? "" : verb.name.substr(space + 1);
}

// What stands in brackets or behind a colon means something to zsh.
std::string zsh_text(std::string text) {
    for (const char c : {'[', ']', ':'})
        for (std::size_t at = 0; (at = text.find(c, at)) != std::string::npos; at += 2) text.insert(at, "\\");
    return text;
}

std::string zsh_value(const OptionText& option) {
    const auto choices = choices_of(option);
    if (!choices.empty()) return ":value:(" + joined_words(choices) + ")";
    return option.value.empty() ? "" : ":" + zsh_text(option.value) + ":_files";
}

}  // namespace

std::string bash_completion(const std::vector<VerbText>& program) {
    const auto& name = program.front().name;
    std::string text = "# completion of " + name + " for bash\n_" + name + "() {\n";
    text += "    local word=${COMP_WORDS[COMP_CWORD]} before=${COMP_WORDS[COMP_CWORD-1]} verb= flags= values=\n";
    text += "    local at=\"${COMP_WORDS[1]-}\" two=\"${COMP_WORDS[1]-} ${COMP_WORDS[2]-}\"\n";
    for (const bool two : {false, true}) {
        text += std::string("    case $") + (two ? "two" : "at") + " in\n";
        for (const auto& verb : program) {
            const auto words = verb_words(verb);
            const bool has_two = words.find(' ') != std::string::npos;
            if (two != has_two || words.empty()) continue;
            text += "        " + quoted(words) + ") verb=" + quoted(words) +
                    " flags=" + quoted(joined_words(flags_of_verb(verb)) + " " + joined_words(verb.verbs)) + ";;\n";
        }
        if (!two)
            text +=
                "        *) flags=" +
                quoted(joined_words(flags_of_verb(program.front())) + " help " + joined_words(program.front().verbs)) +
                ";;\n";
        else
            text += "        *) ;;\n";
        text += "    esac\n";
    }
    text += "    case \"$verb:$before\" in\n";
    for (const auto& verb : program)
        for (const auto& option : verb.options)
            if (const auto choices = choices_of(option); !option.word && !choices.empty())
                for (const auto& flag : option.names)
                    text += "        " + quoted(verb_words(verb) + ":" + flag) +
                            ") values=" + quoted(joined_words(choices)) + ";;\n";
    text += "        *) ;;\n    esac\n";
    text +=
        "    if [ -n \"$values\" ]; then flags=$values; elif [ \"$COMP_CWORD\" -gt 1 ] && [[ $word != -* ]]; then\n";
    text += "        [[ $verb == scene && $COMP_CWORD -eq 2 ]] || flags=\n    fi\n";
    text += "    COMPREPLY=($(compgen -W \"$flags\" -- \"$word\"))\n}\n";
    return text + "complete -o default -o bashdefault -F _" + name + " " + name + "\n";
}

std::string zsh_completion(const std::vector<VerbText>& program) {
    const auto& name = program.front().name;
    std::string text = "#compdef " + name + "\n_" + name + "() {\n    local -a options\n    case \"${words[2]-}\" in\n";
    const auto arguments = [](const VerbText& verb) {
        std::string options;
        for (const auto& option : verb.options)
            if (!option.word)
                for (const auto& flag : option.names)
                    options += " \\\n                " +
                               quoted("*" + flag + "[" + zsh_text(option.help) + "]" + zsh_value(option));
        return "_arguments" + options;
    };
    for (const auto& verb : program) {
        const auto words = verb_words(verb);
        if (words.empty() || words.find(' ') != std::string::npos) continue;
        text += "        " + words + ") " + arguments(verb) + " \\\n                '*:file:_files';;\n";
    }
    const auto& self = program.front();
    text += "        *) " + arguments(self) +
            (self.verbs.empty() ? " \\\n                '*:file:_files'"
                                : " \\\n                '1:verb:(" + joined_words(self.verbs) + ")'") +
            ";;\n    esac\n}\n_" + name + " \"$@\"\n";
    return text;
}

std::string fish_completion(const std::vector<VerbText>& program) {
    const auto& name = program.front().name;
    std::string text = "# completion of " + name + " for fish\n";
    for (const auto& verb : program) {
        const auto words = verb_words(verb);
        if (words.find(' ') != std::string::npos) continue;
        const std::string when = !words.empty()       ? " -n '__fish_seen_subcommand_from " + words + "'"
                                 : program.size() > 1 ? std::string(" -n __fish_use_subcommand")
                                                      : std::string();
        if (!words.empty())
            text +=
                "complete -c " + name + " -n __fish_use_subcommand -f -a " + words + " -d " + quoted(verb.help) + "\n";
        for (const auto& option : verb.options) {
            if (option.word) continue;
            text += "complete -c " + name + when;
            for (const auto& flag : option.names)
                text += (flag.starts_with("--") ? " -l " + flag.substr(2) : " -s " + flag.substr(1));
            if (const auto choices = choices_of(option); !choices.empty())
                text += " -x -a " + quoted(joined_words(choices));
            else if (!option.value.empty())
                text += " -r";
            text += " -d " + quoted(option.help) + "\n";
        }
    }
    return text;
}

}  // namespace lightnet
