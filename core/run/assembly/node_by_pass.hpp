// A node that is made anew for each pass of the picture.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>

#include "core/network/light/light_op.hpp"

namespace lightnet {

/// Stands for the node, and hands each question to the one that was made for its pass. The one of the pass before is
/// kept as well: a copy of work that others have done already may still ask it. So there are never more than two, and
/// whoever is still called after that. Belongs to one place.
class NodeByPass final : public LightOp {
public:
    using Make = std::function<std::unique_ptr<LightOp>(std::uint32_t pass)>;
    explicit NodeByPass(Make make) : make_(std::move(make)) {}

    /// From now on, it is that of this pass.
    void begin(std::uint32_t pass) const;
    /// What it has learnt is let go of. Where it is to prepare again, it is made anew.
    void leave() { now_ = before_ = {}; }

    /// Prepares it for the pass that has begun.
    void prepare(Services& services) override;
    Frozen frozen() const override;
    /// Questions of passes that are over get black answers, which nobody waits for. Throws Error at a question that
    /// names no pass.
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override;

private:
    struct Version {
        std::shared_ptr<LightOp> light;
        std::uint32_t pass = 0;
        bool prepared = false;
    };
    std::shared_ptr<const LightOp> of(std::uint16_t mark) const;

    Make make_;
    // Which of them there are follows from the questions: those of a rehearsal may be the first of a pass.
    mutable Version now_, before_;
};

}  // namespace lightnet
