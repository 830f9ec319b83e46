#include "core/run/place/own_time.hpp"

#include "core/base/processor_time.hpp"

namespace lightnet {

OwnTime::Nanoseconds OwnTime::now() const { return thread_processor_time() + slept_; }

}  // namespace lightnet
