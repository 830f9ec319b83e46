// lightnet doctor: is this machine, and are others, fit for runs?
#include <CLI/CLI.hpp>

#include <algorithm>
#include <chrono>
#include <ostream>
#include <string>
#include <vector>

#include "core/base/build_info.hpp"
#include "core/network/graph/check_hosts.hpp"
#include "lua/load_graph.hpp"
#include "tools/command_line.hpp"
#include "tools/doctor.hpp"
#include "tools/exit_code.hpp"
#include "tools/launcher.hpp"

namespace lightnet {
namespace {

struct DoctorOptions {
    std::vector<std::string> whom;  // endpoints and hosts files
    std::string cache;
};

void describe_doctor(CLI::App& app, DoctorOptions& options) {
    app.add_option("--hosts", options.whom, "ask these, too: hosts files, or endpoints of daemons (may be repeated)")
        ->type_name("FILE");
    app.add_option("--cache", options.cache, "folder of the cache (default: ~/.cache/lightnet)")->type_name("FOLDER");
    add_examples(app, {"lightnet doctor", "lightnet doctor --hosts tcp://127.0.0.1:7777"});
}

std::vector<std::string> endpoints_of(const DoctorOptions& options, std::vector<Finding>& findings) {
    std::vector<std::string> endpoints;
    for (const auto& one : options.whom) {
        if (address_of(one)) {
            endpoints.push_back(one);
            continue;
        }
        for (const auto& host : load_hosts(one).hosts) {
            if (host.is_here()) continue;
            if (address_of(host.endpoint))
                endpoints.push_back(host.endpoint);
            else
                findings.push_back({Finding::Grade::doubtful, host.endpoint, "joins by itself, so it can't be asked",
                                    "run lightnet doctor there"});
        }
    }
    return endpoints;
}

int look_at_all(const DoctorOptions& options, const Launcher& launcher) {
    std::vector<Finding> joining;
    const auto endpoints = endpoints_of(options, joining);  // before there are threads
    auto findings = look_at_this_machine(options.cache);
    const auto hosts = look_at_hosts(probe_hosts(endpoints, std::chrono::seconds(5)), build_id());
    findings.insert(findings.end(), hosts.begin(), hosts.end());
    findings.insert(findings.end(), joining.begin(), joining.end());
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
