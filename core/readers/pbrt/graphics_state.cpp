#include "core/readers/pbrt/graphics_state.hpp"

#include <fmt/format.h>

#include <utility>

namespace lightnet::pbrt {

void Blocks::begin(Kind kind, const SourceLine& where) {
    constexpr std::size_t deepest = 10000;
    if (open_.size() == deepest) sources_.report.error(where, "blocks are nested too deeply");
    if (open_.size() < deepest) open_.push_back({kind, state_, where});
}

bool Blocks::end(Kind kind, const char* what, const SourceLine& where) {
    if (open_.empty() || open_.back().kind != kind) {
        std::string problem = fmt::format("there is no {} to end here", what);
        if (!open_.empty() && open_.back().kind != Kind::import)
            problem += fmt::format(" (the latest open block begins in line {})", open_.back().where.line);
        sources_.report.error(where, problem);
        return false;
    }
    state_ = std::move(open_.back().before);
    open_.pop_back();
    return true;
}

void Blocks::end_transform(const SourceLine& where) {
    GraphicsState current = state_;
    if (!end(Kind::transform, "TransformBegin", where)) return;
    current.to_world = state_.to_world;
    state_ = std::move(current);
}

bool Blocks::end_import() {
    bool object = false;
    while (!open_.empty() && open_.back().kind != Kind::import) {
        sources_.report.error(open_.back().where, "this block is not closed in its file");
        object |= open_.back().kind == Kind::object;
        state_ = std::move(open_.back().before);
        open_.pop_back();
    }
    end(Kind::import, "import", {});
    return object;
}

void Blocks::end_file() {
    for (const auto& open : open_) sources_.report.error(open.where, "this block is never closed");
    open_.clear();
}

}  // namespace lightnet::pbrt
