// The frozen state of a node, in the hands of a node that takes it.
#pragma once

#include <memory>
#include <typeinfo>
#include <utility>

#include "core/base/error.hpp"

namespace lightnet {

/// State of a node that has prepared: photons, records. Constant and shared by all places of a process; a conversion
/// between representations of light takes one and makes another of it. Nothing of it travels: every place that holds
/// the taker holds the node as well.
class Frozen {
public:
    Frozen() = default;
    template <class T>
    explicit Frozen(std::shared_ptr<const T> value) : value_(std::move(value)), type_(&typeid(T)) {}

    /// Null when there was nothing to learn. Throws Error when it is something else.
    template <class T>
    std::shared_ptr<const T> as() const {
        if (!type_ || *type_ != typeid(T)) throw Error("the node that it takes from keeps nothing of that kind");
        return std::static_pointer_cast<const T>(value_);
    }

private:
    std::shared_ptr<const void> value_;
    const std::type_info* type_ = nullptr;
};

}  // namespace lightnet
