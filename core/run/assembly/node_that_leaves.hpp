// A node that prepares, and may leave its place when others hold it.
#pragma once

#include <cstddef>
#include <functional>
#include <memory>
#include <span>

#include "core/network/light/light_op.hpp"

namespace lightnet {

/// Stands for the node, so that what it has learnt can be let go of while others know it. Belongs to one place.
class NodeThatLeaves final : public LightOp {
public:
    using Make = std::function<std::unique_ptr<LightOp>()>;
    explicit NodeThatLeaves(Make make) : make_(std::move(make)), light_(make_()) {}

    /// The node goes, as soon as no call is in it any more. Where it is to prepare again, it is made anew.
    void leave();
    bool has_left() const { return leaves_ || !light_; }

    void prepare(Services& services) override;
    Frozen frozen() const override;
    /// Throws Error when it has left: whoever asks should know.
    void light(std::span<const Query> questions, std::span<Rgb> answers) const override;

private:
    class Visit;
    LightOp& node() const;

    Make make_;
    mutable std::unique_ptr<LightOp> light_;
    mutable std::size_t inside_ = 0;  // calls
    bool leaves_ = false;
};

}  // namespace lightnet
