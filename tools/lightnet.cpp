// The launcher: the one place where all rooms meet.
#include <exception>
#include <iostream>
#include <string>
#include <utility>
#include <vector>

#include "core/base/words_of.hpp"
#include "lua/custom.hpp"
#include "nodes/examples/candela/candela_kinds.hpp"
#include "nodes/standard_nodes.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/outside/outside.hpp"
#include "tools/session/run.hpp"
#include "tools/session/sequence.hpp"
#include "tools/session/session.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/support/plugins.hpp"
#include "tools/support/signals.hpp"
#include "tools/support/standard_output.hpp"
#include "tools/trials/trial_runs.hpp"
#include "transport/places/descriptors.hpp"

namespace {

int perform(const std::vector<std::string>& words) try {
    lightnet::raise_descriptor_limit();
    lightnet::Registry registry{lightnet::standard_nodes()};
    registry.add(lightnet::candela_kinds());  // an example: code that was written for something else
    registry.add({lightnet::custom_kind(), lightnet::outside_kind()});
    lightnet::load_installed_plugins(registry, std::cerr);
    const auto run = [&](const lightnet::RunRequest& request) { return lightnet::run(request, registry); };
    lightnet::Launcher launcher{registry, run, std::cout, std::cerr};
    launcher.run_sequence = [&](lightnet::Sequence sequence) {
        return lightnet::run_sequence(std::move(sequence), registry);
    };
    lightnet::TrialRuns trials(registry);
    launcher.try_run = [&](const lightnet::RunRequest& request, double seconds) {
        return trials.run(request, seconds);
    };
    launcher.run_tried = [&](const lightnet::RunRequest& request) { return trials.run_to_end(request); };
    launcher.run_session = [&](const lightnet::Session& session) { return lightnet::run_session(session, registry); };
    launcher.plug = [&](const std::vector<std::string>& files) {
        lightnet::load_plugins(files, registry);
        lightnet::pass_on_plugins(files);
    };
    launcher.settings = lightnet::settings_of_launcher();
    return launcher(words);
} catch (const lightnet::UserError& error) {  // in what the user has settled
    std::cerr << error.what() << '\n';
    return lightnet::exit_code::usage;
} catch (const std::exception& error) {
    std::cerr << "lightnet: " << lightnet::words_of(error) << '\n';
    return lightnet::exit_code::failed;
}

}  // namespace

int main(int count, char** words) {
    lightnet::end_on_signals(lightnet::exit_code::interrupted, "lightnet: stopped by a signal\n");
    lightnet::keep_standard_descriptors();
    lightnet::StandardOutput output;
    return output.end(perform({words + 1, words + count}), "lightnet");
}
