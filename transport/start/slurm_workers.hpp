// Daemons that Slurm starts, on whatever nodes it has.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "transport/keys/key.hpp"

namespace lightnet {

/// A job array, each element a lightnetd that dials in at the launcher. Slurm starts them when it has nodes, and anew
/// when a node is lost. Cancelled with this object; elements whose launcher is gone leave by themselves.
class SlurmWorkers {
public:
    struct Request {
        std::string program;  // lightnetd, as the nodes find it
        std::string join;     // endpoint of the launcher, as the nodes reach it
        std::uint32_t daemons = 1;
        std::string partition;               // "": Slurm's usual one
        std::vector<std::string> arguments;  // more words for sbatch
        // By which the daemons and the launcher know each other; none: by the pass.
        struct Keys {
            std::string
                file;  // with the daemons' secret key, as the nodes find it: the script itself lies in Slurm's spool
            PublicKey launcher;
        };
        std::optional<Keys> keys{};
        std::string pass{};  // file with what they must know to join, as the nodes find it; "": the usual one
    };
    /// Submits the array. Throws Error with what sbatch said when it doesn't take it.
    explicit SlurmWorkers(const Request& request);
    ~SlurmWorkers();
    SlurmWorkers(const SlurmWorkers&) = delete;
    SlurmWorkers& operator=(const SlurmWorkers&) = delete;

    /// Number of the array job.
    const std::string& job() const { return job_; }

private:
    std::string job_;
};

/// What each element runs.
std::string slurm_script(const SlurmWorkers::Request& request);

}  // namespace lightnet
