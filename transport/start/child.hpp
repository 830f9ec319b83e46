// Programs that the launcher starts.
#pragma once

#include <chrono>
#include <string>
#include <vector>

namespace lightnet {

/// Starts a program (looked for in PATH when it has no slash) whose standard output comes back through `*out`. Returns
/// its process. `more`: of its environment, beside ours: "NAME=value". Throws Error.
int spawn(std::vector<std::string> words, int* out, std::vector<std::string> more = {});

/// Starts a program in a process group of its own, so that Ctrl-C is not for it, whose standard input is what is
/// written to `*in`, and which is to end when that is closed; what it says on its standard output is thrown away.
/// Throws Error.
int spawn_led(std::vector<std::string> words, int* in);

/// What a program said, to both outputs, and how it ended.
struct ProgramOutput {
    int code = -1;  // 128 + signal if one ended it
    std::string text;
};
/// Runs a program to its end, with `input` as its standard input; kills it after `most`. Throws Error when it can't be
/// started.
ProgramOutput run_program(std::vector<std::string> words, const std::string& input, std::chrono::milliseconds most);

}  // namespace lightnet
