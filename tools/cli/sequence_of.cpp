#include "tools/cli/sequence_of.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <string>
#include <utility>

#include "core/base/error.hpp"
#include "core/base/frame_name.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {
namespace {

// What is shown of one picture can't be shown of many; files of their own can, where each has a name.
void check_together(const RunningOptions& running) {
    const auto refuse = [](const std::string& option, const std::string& why) { throw UserError({option, 0}, why); };
    if (running.viewer) refuse("--preview tev", "a viewer is shown one picture: leave it out, or ask for one frame");
    for (const auto& [option, file] : {std::pair("--report", &running.report),
                                       {"--trace", &running.trace},
                                       {"--csv", &running.curve},
                                       {"--npz", &running.arrays}})
        if (!file->empty() && !has_frame_place(*file)) {
            const std::filesystem::path path(*file);
            const auto better = path.parent_path() / (path.stem().string() + ".####" + path.extension().string());
            refuse(option, "each frame has one of its own: " + better.string() + ", not " + *file);
        }
}

RunningOptions for_frame(const RunningOptions& running, int frame) {
    RunningOptions own = running;
    for (auto* name : {&own.picture.output, &own.arrays, &own.report, &own.trace, &own.curve, &own.reference})
        *name = with_frame(*name, frame);
    return own;
}

// Names which frame a mistake is in.
UserError at_frame(int frame, const UserError& error) {
    auto problems = error.problems();
    for (auto& problem : problems) problem.what += " (at frame " + std::to_string(frame) + ")";
    return UserError(std::move(problems));
}

// Every picture has a file of its own.
void name_pictures(Sequence& sequence) {
    std::map<std::string, int> taken;
    for (auto& run : sequence.frames) {
        const int frame = run.frame->number;
        const auto [first, fresh] = taken.emplace(run.output, frame);
        if (fresh) continue;
        const std::filesystem::path path(run.output);
        const auto better = path.parent_path() / (path.stem().string() + ".####" + path.extension().string());
        throw UserError({run.output, 0}, "frames " + std::to_string(first->second) + " and " + std::to_string(frame) +
                                             " would be the same file: give the name a place for the number, like -o " +
                                             better.string());
    }
}

}  // namespace

Sequence sequence_of(const FrameOptions& frames, const RunningOptions& running, const RunOfFrame& run_of) {
    const auto& numbers = frames.numbers;
    if (numbers.size() > 1) check_together(running);
    Sequence sequence;
    GraphFrame frame{0, *std::max_element(numbers.begin(), numbers.end()), true};
    std::string pattern = running.picture.output;
    for (const int number : numbers) {
        frame.number = number;
        auto own = for_frame(running, number);
        if (number != numbers.front()) own.progress = ProgressMode::none;  // warnings are said once
        try {
            sequence.frames.push_back(run_of(frame, own));
        } catch (const UserError& error) {
            throw numbers.size() > 1 ? at_frame(number, error) : error;
        }
        auto& run = sequence.frames.back();
        run.progress = running.progress;
        run.frame = FrameOfSequence{number, 0, numbers.size(), {}};
        run.forget = true;
        if (pattern.empty()) pattern = run.output;
        run.output = with_frame(run.output, number);
    }
    name_pictures(sequence);
    if (!has_frame_place(pattern)) pattern = frame_place_for(pattern);
    if (numbers.size() > 1 && !pattern.empty()) sequence.report = report_beside(without_frame_place(pattern)).string();
    return sequence;
}

int run_frames(const FrameOptions& frames, const RunningOptions& running, const Launcher& launcher,
               const RunOfFrame& run_of) {
    return launcher.run_sequence(sequence_of(frames, running, run_of));
}

}  // namespace lightnet
