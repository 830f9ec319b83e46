#include "transport/start/slurm_workers.hpp"

#include <algorithm>
#include <chrono>

#include "core/base/error.hpp"
#include "transport/start/child.hpp"
#include "transport/start/shell_word.hpp"
#include "transport/wire/loopback.hpp"

namespace lightnet {
namespace {

using namespace std::chrono_literals;

constexpr auto most_time = 30s;  // for a controller that is busy

// By what the daemon is let in.
std::string way_in(const SlurmWorkers::Request& request) {
    if (request.keys)
        return " --key " + as_shell_word(request.keys->file) + " --launcher-key " + request.keys->launcher.text();
    return (request.pass.empty() ? "" : " --pass " + as_shell_word(request.pass)) +
           (stays_on_this_machine(request.join) ? "" : " --insecure");
}

}  // namespace

std::string slurm_script(const SlurmWorkers::Request& request) {
    // exec: a shell between Slurm and the daemon would outlive it, and keep its signals from it.
    return "#!/bin/sh\n"
           "name=slurm-$SLURM_ARRAY_JOB_ID-$SLURM_ARRAY_TASK_ID\n"
           "exec " +
           as_shell_word(request.program) + " --join " + as_shell_word(request.join) +
           " --name \"$name\" --single \"$name\" --places \"${SLURM_CPUS_ON_NODE:-0}\" --leave-after 60" +
           way_in(request) + "\n";
}

SlurmWorkers::SlurmWorkers(const Request& request) {
    std::vector<std::string> words{"sbatch",    "--parsable",          "--array=1-" + std::to_string(request.daemons),
                                   "--requeue", "--job-name=lightnet", "--nodes=1",
                                   "--ntasks=1"};
    if (!request.partition.empty()) words.push_back("--partition=" + request.partition);
    // Many daemons would write into the user's folder; who wants to read what they say gives --output.
    const auto is_output = [](const std::string& word) { return word.starts_with("--output") || word == "-o"; };
    if (std::none_of(request.arguments.begin(), request.arguments.end(), is_output))
        words.push_back("--output=/dev/null");
    words.insert(words.end(), request.arguments.begin(), request.arguments.end());
    const auto said = run_program(words, slurm_script(request), most_time);
    // "--parsable" gives the number, perhaps with ";cluster" behind it; warnings may stand before.
    const auto line = said.text.substr(0, said.text.find_last_not_of(" \n") + 1);
    job_ = line.substr(line.find_last_of('\n') + 1);
    job_ = job_.substr(0, job_.find(';'));
    const bool number = !job_.empty() && job_.find_first_not_of("0123456789") == std::string::npos;
    if (said.code != 0 || !number) throw Error("sbatch", "does not take the job: " + line);
}

SlurmWorkers::~SlurmWorkers() {
    try {
        run_program({"scancel", job_}, "", most_time);
    } catch (const std::exception&) {  // then they leave by themselves
    }
}

}  // namespace lightnet
