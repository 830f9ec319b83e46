// Brings what took hours to a disk, whatever has become of its folder meanwhile.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <string>
#include <vector>

#include "tools/request/run_request.hpp"
#include "tools/session/run_recorder.hpp"

namespace lightnet {

/// How a finished picture is written, and what is done when it can't be.
struct Delivery {
    std::function<void(const std::string& picture)> write;  // with all that belongs to it; throws what is wrong
    std::chrono::seconds patience{30};                      // as long as this, it is tried again and again
    std::function<bool()> hurried = [] { return false; };   // true: no patience any more
    std::function<void(const std::string&)> say = [](const std::string&) {};
    std::vector<std::string> elsewhere;  // folders for a last resort, in this order
};

/// Where people look for what could not be put where it belongs: $TMPDIR or else /tmp, then the home folder.
std::vector<std::string> folders_of_last_resort();

/// A folder of its own, which no file of others can be in the way of; "": it can't be made.
std::string new_folder_in(const std::string& folder);

/// Where it is now: `picture`, or a file of that name in a new folder elsewhere. Throws Error when it is nowhere.
std::string deliver(const Delivery& delivery, const std::string& picture);

/// Writes the picture of a run whose film is complete, and what belongs to it, and sums up; `hurried` ends patience,
/// `exposure` is that of the PNG, in stops. Returns an exit code. Throws Error when the picture is nowhere.
int finish_run(RunRecorder& book, const RunRequest& request, double exposure, const std::atomic<bool>& hurried);

}  // namespace lightnet
