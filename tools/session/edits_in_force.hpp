// Edits of a session that hold, and those that are taken back.
#pragma once

#include <functional>
#include <optional>
#include <utility>
#include <vector>

#include "tools/request/graph_edits.hpp"
#include "tools/request/run_request.hpp"

namespace lightnet {

/// What has been said since a session began. An edit that can't be made changes nothing: with those that hold the graph
/// can be read, and so can its scene, as long as no file is at fault. One thread's.
class EditsInForce {
public:
    /// The run that edits ask for. Throws UserError.
    using Read = std::function<RunRequest(const GraphEdits& edits)>;
    explicit EditsInForce(Read read) : read_(std::move(read)) {}

    /// Throws UserError where the edit is at fault: it changes nothing. Where a file is, it holds all the same.
    void take(const Edit& edit);
    /// An edit is none, and changes nothing.
    void refuse() { refused_ = true; }
    /// Something turned up after take(): the last edit of which nothing has been shown changes nothing after all.
    /// False: there is none, so that a file is at fault.
    bool take_back();
    /// The last edit came to nothing.
    bool refused() const { return refused_; }

    /// The run as they have it. Throws UserError.
    RunRequest request();
    /// Seconds that reading the graph took.
    double read_seconds() const { return seconds_; }

    /// Something of their picture was shown: they can be made, with the files as they are.
    void shown();
    void set_finished(bool finished) { finished_ = finished; }
    /// Their picture is there, and finished.
    bool finished() const { return finished_; }
    /// Files are others than they were.
    void forget_files();

private:
    struct Before {
        GraphEdits edits;
        bool finished;
    };
    void read(const GraphEdits& edits);
    bool can_be_read(const GraphEdits& edits);

    Read read_;
    GraphEdits edits_;
    std::vector<Before> before_;         // each edit of which nothing has been shown
    std::optional<RunRequest> request_;  // as they have it, where it has been read already
    double seconds_ = 0;
    bool files_hold_ = false;  // they have given a picture
    bool finished_ = false, refused_ = false;
};

}  // namespace lightnet
