// lightnet manual: the programs' command lines as manual pages, pages of the reference, and completions of shells.
#include <CLI/CLI.hpp>

#include <algorithm>
#include <filesystem>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/atomic_file.hpp"
#include "core/base/suggestion.hpp"
#include "core/network/graph/describe.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/cli/schema_text.hpp"
#include "tools/daemon/daemon_options.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"
#include "tools/words/program_text.hpp"

namespace lightnet {
namespace {

struct ManualOptions {
    std::string page = "lightnet";
    std::string form = "markdown";
    std::string folder;  // "": print one
};

using Texts = std::vector<VerbText>;

const std::vector<std::string> forms{"markdown", "man", "bash", "zsh", "fish"};

void describe_manual(CLI::App& app, ManualOptions& options) {
    app.add_option("PAGE", options.page, "lightnet, lightnetd, or a verb")->capture_default_str();
    app.add_option("--as", options.form, "how it is written; a shell's name: its completion of the program")
        ->type_name("markdown|man|bash|zsh|fish")
        ->check([](const std::string& text) {
            return std::find(forms.begin(), forms.end(), text) != forms.end()
                       ? ""
                       : "must be markdown, man, bash, zsh or fish, not '" + text + "'";
        });
    app.add_option("--all", options.folder, "write everything for both programs into this folder instead")
        ->type_name("FOLDER");
    add_examples(app, {"lightnet manual run", "lightnet manual lightnet --as bash"});
}

Texts program_of(const std::string& page, const Launcher& launcher) {
    return page.starts_with("lightnetd") ? daemon_texts() : launcher_texts(launcher.verbs);
}

std::string written(const Texts& program, const VerbText& page, const std::string& form) {
    if (form == "man") return manual_page(page);
    if (form == "bash") return bash_completion(program);
    if (form == "zsh") return zsh_completion(program);
    if (form == "fish") return fish_completion(program);
    return markdown_page(page);
}

void write(const std::filesystem::path& path, const std::string& text) {
    std::filesystem::create_directories(path.parent_path());
    write_file(path, text);
}

// A page with what `describe` says of each kind.
std::string kinds_page(const Registry& registry) {
    std::string text = "# Kinds of nodes\n";
    for (const auto& kind : registry.kinds()) text += "\n## " + kind.name + "\n\n```text\n" + describe(kind) + "```\n";
    return text;
}

// Where a system expects them, below its folder for what programs share; and the reference's pages.
void write_all(const std::filesystem::path& folder, const Launcher& launcher) {
    write(folder / "reference/nodes.md", kinds_page(launcher.registry));
    write(folder / "reference/schema.json", schema_json(launcher.registry.kinds()));
    write(folder / "lightnet/lightnet.meta.lua", lua_definitions(launcher.registry.kinds()));
    write(folder / "lightnet/luacheckrc", luacheck_settings(launcher.registry.kinds()));
    for (const auto& program : {launcher_texts(launcher.verbs), daemon_texts()}) {
        const auto& name = program.front().name;
        for (const auto& page : program) {
            if (page.name == "lightnet help") continue;
            write(folder / "man/man1" / (page_name(page) + ".1"), manual_page(page));
            write(folder / "reference" / (page_name(page) + ".md"), markdown_page(page));
        }
        write(folder / "bash-completion/completions" / name, bash_completion(program));
        write(folder / "zsh/vendor-completions" / ("_" + name), zsh_completion(program));
        write(folder / "fish/vendor_completions.d" / (name + ".fish"), fish_completion(program));
    }
}

int print_manual(const ManualOptions& options, const Launcher& launcher) {
    if (!options.folder.empty()) {
        write_all(options.folder, launcher);
        return exit_code::done;
    }
    const Texts program = program_of(options.page, launcher);
    std::vector<std::string> names{"lightnetd"};
    for (const auto& page : program) {
        names.push_back(page_name(page));
        if (page_name(page) != options.page && page_name(page) != "lightnet-" + options.page) continue;
        launcher.out << written(program, page, options.form);
        return exit_code::done;
    }
    launcher.err << "lightnet: there is no page '" << options.page << "'" << did_you_mean(options.page, names) << '\n';
    return exit_code::usage;
}

}  // namespace

Verb manual_verb() {
    return verb<ManualOptions>("manual", "print a page of the manual, or completions for a shell", describe_manual,
                               print_manual);
}

}  // namespace lightnet
