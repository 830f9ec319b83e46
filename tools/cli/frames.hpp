// The frames of a sequence, as the command line names them.
#pragma once

#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace CLI {
class App;
}

namespace lightnet {

/// What a verb that makes pictures is told of frames.
struct FrameOptions {
    std::vector<int> numbers;  // in the order in which they are wanted, each once; none: a still
    double fps = 0;            // frames per second; 0: as the graph says
};

/// "1-240", "1-240x2" or "1,5,9-12" as numbers; or what is wrong with it.
std::variant<std::vector<int>, std::string> frames_of(std::string_view text);

/// --frames and --fps
void add_frames(CLI::App& verb, FrameOptions& frames);
/// --frames of a sequence that is there
void add_only_frames(CLI::App& verb, std::vector<int>& numbers);

}  // namespace lightnet
