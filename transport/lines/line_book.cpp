#include "transport/lines/line_book.hpp"

#include <utility>

namespace lightnet {

void LineBook::use(Entries entries) {
    const std::lock_guard lock(mutex_);
    if (entries == entries_) return;
    entries_ = std::move(entries);
    edition_.fetch_add(1, std::memory_order_release);
}

LineBook::Entries LineBook::entries() const {
    const std::lock_guard lock(mutex_);
    return entries_;
}

}  // namespace lightnet
