// What one question costs that wrapped code asks by itself.
#pragma once

#include "tests/bench/picture.hpp"

namespace lightnet::bench {

/// carrier.scalar_inproc: processor time of the asking place, per question. `picture` lends its scene.
void measure_scalar_inproc(const Picture& picture);
/// carrier.scalar_tcp: processor time of everybody in the process, per question.
void measure_scalar_tcp(const Picture& picture);

}  // namespace lightnet::bench
