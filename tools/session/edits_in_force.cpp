#include "tools/session/edits_in_force.hpp"

#include <chrono>
#include <utility>

#include "core/base/error.hpp"
#include "tools/support/pace.hpp"

namespace lightnet {

void EditsInForce::take(const Edit& edit) {
    GraphEdits edits = edits_;
    lightnet::take(edit, edits);
    if (files_hold_) {
        try {
            read(edits);
            before_.push_back({edits_, finished_});
        } catch (const UserError&) {
            if (can_be_read(edits_)) throw;
            forget_files();  // whose change has not been told of yet
        }
    }
    edits_ = std::move(edits);
    finished_ = refused_ = false;
}

bool EditsInForce::take_back() {
    if (before_.empty()) {
        files_hold_ = false;
        return false;
    }
    edits_ = std::move(before_.back().edits);
    finished_ = before_.back().finished;
    before_.pop_back();
    request_.reset();
    refused_ = true;
    return true;
}

RunRequest EditsInForce::request() {
    if (!request_) read(edits_);
    return std::move(*std::exchange(request_, std::nullopt));
}

void EditsInForce::shown() {
    files_hold_ = true;
    before_.clear();
}

void EditsInForce::forget_files() {
    files_hold_ = false;
    before_.clear();
    request_.reset();
}

void EditsInForce::read(const GraphEdits& edits) {
    const auto begun = std::chrono::steady_clock::now();
    request_.emplace(read_(edits));
    seconds_ = seconds_since(begun);
}

bool EditsInForce::can_be_read(const GraphEdits& edits) try {
    read(edits);
    return true;
} catch (const UserError&) {
    return false;
}

}  // namespace lightnet
