// lightnet key: makes the key of this user, and shows its public half.
#include <CLI/CLI.hpp>

#include <pwd.h>
#include <unistd.h>

#include <ostream>
#include <string>

#include "core/base/this_machine.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"
#include "transport/keys/key_file.hpp"

namespace lightnet {
namespace {

struct KeyOptions {
    std::string file;  // "": the usual one
};

void describe_key(CLI::App& app, KeyOptions& options) {
    app.add_option("--key", options.file, "file with the secret key (default: ~/.config/lightnet/key)")
        ->type_name("FILE");
    add_examples(app, {"lightnet key"});
}

std::string user_name() {
    const passwd* user = getpwuid(getuid());
    return (user ? user->pw_name : std::to_string(getuid())) + "@" + machine_name();
}

// A line for lists of keys.
int print_own_key(const KeyOptions& options, const Launcher& launcher) {
    const auto file = options.file.empty() ? usual_key_file() : options.file;
    const bool made = !key_is_there(file);
    const auto key = load_or_make_key(file).open;
    launcher.out << key.text() << ' ' << user_name() << '\n';
    launcher.err << (made ? "made " : "of ") << file << "; fingerprint " << key.fingerprint() << '\n';
    return exit_code::done;
}

}  // namespace

Verb key_verb() {
    return verb<KeyOptions>("key", "make the key by which daemons know you, once, and print its public half",
                            describe_key, print_own_key);
}

}  // namespace lightnet
