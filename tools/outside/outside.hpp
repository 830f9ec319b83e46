// Operators that are functions of the process that started this run, such as a Python interpreter.
#pragma once

#include "core/network/graph/kind.hpp"

namespace lightnet {

/// The kind Outside, for the launcher: it answers at this process's places alone. The environment's LIGHTNET_OUTSIDE
/// names the Unix socket at which that process listens.
///
/// A call of light() opens with 'q': the number of questions and of inputs (32 bits each, the lowest byte first), then
/// the function's name. The function's side then wants columns, each of which comes back as 'c': 32-bit floats, the
/// numbers of one question side by side.
///   'p', 'n', 'o', 'a'  position (scene units), normal on the side that is asked about, direction that the answer goes
///                       to, even albedo; three numbers each
///   'r' which of        points in the unit square; two numbers (see QuestionBatch::random)
///   'h' normals points  directions around normals, as many as their cosine; three
///   'f' distance directions   1 where nothing is in the way, else 0; one
///   'i' input           radiance that an input answers with; three
///   'd' input directions      radiance that arrives from there; three
/// It closes with 'v' and a column of one or three numbers, the answer, or 'e' and a text, what went wrong.
Kind outside_kind();

}  // namespace lightnet
