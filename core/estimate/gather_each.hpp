// Points of questions as their light is gathered.
#pragma once

#include <cstddef>
#include <span>

#include "core/estimate/path_vertices.hpp"

namespace lightnet {

/// with(index, Gathering) of each question, in another order than theirs.
template <class With>
void gather_each(const Scene& scene, std::span<const Query> questions, With&& with) {
    PathVertices vertices(scene);
    for (std::size_t next = 0; next < questions.size();) {
        next = vertices.begin(next, questions.size(), [&](std::size_t i) -> const Query& { return questions[i]; });
        vertices.find_bsdfs();
        vertices.each(with);
    }
}

}  // namespace lightnet
