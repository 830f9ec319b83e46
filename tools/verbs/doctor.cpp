// lightnet doctor: is this machine, and are others, fit for runs?
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ostream>
#include <string>

#include "core/base/build_info.hpp"
#include "tools/cli/asked_hosts.hpp"
#include "tools/cli/launcher.hpp"
#include "tools/hosts/doctor.hpp"
#include "tools/support/exit_code.hpp"
#include "tools/words/command_line.hpp"

namespace lightnet {
namespace {

struct DoctorOptions {
    AskedHostsOptions hosts;
    std::string cache;
};

void describe_doctor(CLI::App& app, DoctorOptions& options) {
    app.add_option("--hosts", options.hosts.whom,
                   "ask these, too: hosts files, or endpoints of daemons (may be repeated)")
        ->type_name("FILE");
    add_asking_keys(app, options.hosts);
    app.add_option("--cache", options.cache, "folder of the cache (default: ~/.cache/lightnet)")->type_name("FOLDER");
    add_examples(app, {"lightnet doctor", "lightnet doctor --hosts tcp://127.0.0.1:7777"});
}

int look_at_all(const DoctorOptions& options, const Launcher& launcher) {
    const auto asked = asked_hosts(options.hosts);  // before there are threads
    auto findings = look_at_this_machine(options.cache);
    const auto hosts = look_at_hosts(probe_hosts(asked.called, std::chrono::seconds(5)), build_id());
    findings.insert(findings.end(), hosts.begin(), hosts.end());
    for (const auto& name : asked.joining)
        findings.push_back(
            {Finding::Grade::doubtful, name, "joins by itself, so it can't be asked", "run lightnet doctor there"});
    launcher.out << findings_table(findings);
    if (all_good_enough(findings)) return exit_code::done;
    return all_good_enough(hosts) ? exit_code::failed : exit_code::no_worker;
}

}  // namespace

Verb doctor_verb() {
    return verb<DoctorOptions>("doctor", "look whether this machine, and others, are fit for runs, and say what to do",
                               describe_doctor, look_at_all);
}

}  // namespace lightnet
