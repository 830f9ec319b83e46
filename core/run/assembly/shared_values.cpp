#include "core/run/assembly/shared_values.hpp"

namespace lightnet {

SharedValue::Value SharedValue::get(const Watch& watch, const Make& make) {
    Lock lock(mutex_);
    if (!std::exchange(begun_, true)) {
        lock.unlock();
        make_it(watch, make);
        lock.lock();
    }
    while (!made_)
        if (has_piece())
            do_next(lock);
        else
            changed_.wait(lock);
    if (failure_) std::rethrow_exception(failure_);
    return value_;
}

void SharedValue::make_it(const Watch& watch, const Make& make) {
    watch_ = &watch;
    Value value;
    std::exception_ptr failure;
    try {
        value = make(*this);
    } catch (...) {
        failure = std::current_exception();
    }
    const Lock lock(mutex_);
    value_ = std::move(value);
    failure_ = failure;
    made_ = true;
    changed_.notify_all();
}

void SharedValue::each(std::size_t count, const Piece& piece) {
    Lock lock(mutex_);
    piece_ = &piece;
    next_ = 0;
    count_ = count;
    changed_.notify_all();
    while (has_piece()) do_next(lock);
    changed_.wait(lock, [this] { return under_way_ == 0; });
    if (const auto failure = std::exchange(piece_failure_, nullptr)) std::rethrow_exception(failure);
}

void SharedValue::do_next(Lock& lock) {
    const std::size_t i = next_++, count = count_;
    ++under_way_;
    const Piece& piece = *piece_;
    lock.unlock();
    std::exception_ptr failure;
    try {
        if (*watch_) (*watch_)(i, count);
        piece(i);
    } catch (...) {
        failure = std::current_exception();
    }
    lock.lock();
    if (failure) {
        next_ = count_;
        if (!piece_failure_) piece_failure_ = failure;
    }
    if (--under_way_ == 0) changed_.notify_all();
}

SharedValue::Value SharedValues::get(std::size_t node, std::uint32_t index, const SharedValue::Watch& watch,
                                     const SharedValue::Make& make, std::uint32_t pass) {
    std::shared_ptr<SharedValue> value;
    {
        const std::lock_guard lock(mutex_);
        values_.erase(values_.lower_bound({node, 0, 0}), values_.lower_bound({node, pass, 0}));
        auto& known = values_[{node, pass, index}];
        if (!known) known = std::make_shared<SharedValue>();
        value = known;
    }
    return value->get(watch, make);
}

void SharedValues::forget(std::size_t node) {
    const std::lock_guard lock(mutex_);
    values_.erase(values_.lower_bound({node, 0, 0}), values_.lower_bound({node + 1, 0, 0}));
}

std::size_t SharedValues::size() {
    const std::lock_guard lock(mutex_);
    return values_.size();
}

}  // namespace lightnet
