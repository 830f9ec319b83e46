// A lightnetd of its own, whose process a benchmark knows.
#pragma once

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "transport/start/child.hpp"

namespace lightnet::bench {

/// Killed with this object, and gone when its process is.
class Daemon {
public:
    /// `words`: what else it is told; `more`: of its environment.
    Daemon(const std::string& program, std::uint32_t places, const std::string& cache,
           const std::vector<std::string>& words = {}, std::vector<std::string> more = {}) {
        int out = -1;
        std::vector<std::string> all{program, "--places", std::to_string(places),  "--quiet", "--cache",
                                     cache,   "--parent", std::to_string(getpid())};
        all.insert(all.end(), words.begin(), words.end());
        process_ = spawn(std::move(all), &out, std::move(more));
        std::string line;
        for (char c = 0; read(out, &c, 1) == 1 && c != '\n';) line += c;
        close(out);
        endpoint_ = line.substr(line.find("tcp://"));
    }
    ~Daemon() {
        kill(process_, SIGKILL);
        waitpid(process_, nullptr, 0);
    }
    Daemon(const Daemon&) = delete;
    Daemon& operator=(const Daemon&) = delete;

    int process() const { return process_; }
    const std::string& endpoint() const { return endpoint_; }

private:
    int process_ = 0;
    std::string endpoint_;
};

}  // namespace lightnet::bench
