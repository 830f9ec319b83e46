// Settings of a run, made of its request before anything is rendered.
#pragma once

#include "core/film/film.hpp"
#include "core/network/graph/kind.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/assembly/job.hpp"
#include "tools/request/run_request.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {

/// What its film holds.
FilmFormat film_format(const RunRequest& request, const Registry& registry);

/// What all hosts have to know of it; `files` were read for its scene.
Job make_job(const RunRequest& request, const Registry& registry, const FilmFormat& format, DiskFiles& files);

/// How its report begins.
RunReport first_page(const RunRequest& request, const Registry& registry, const FilmFormat& film);

}  // namespace lightnet
