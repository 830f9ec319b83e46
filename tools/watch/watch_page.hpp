// The page that shows a run: one file, built from tools/watch/page, that needs nothing else.
#pragma once

#include <string_view>

namespace lightnet {

/// Its bytes. In a report, what is shown is frozen into it: see report_page().
std::string_view watch_page();

}  // namespace lightnet
