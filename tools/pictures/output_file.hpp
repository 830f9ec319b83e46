// Rules for where a run may write its files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "core/base/error.hpp"
#include "core/network/graph/graph.hpp"
#include "core/network/graph/kind.hpp"

namespace lightnet {

/// How all pages of reports begin.
inline constexpr std::string_view report_page_beginning = "<!doctype html>\n<!--lightnet-->";

/// Throws UserError when no picture can be written there, or files of others stand where it and what comes with it
/// would: said before work starts, not after hours of it.
void check_output(const std::string& output);
/// Likewise for one of the pictures that come with it, and its PNG.
void check_picture(const std::string& exr);

/// Throws UserError where a picture at `exr`, or its PNG, would replace one of `inputs`: what it is made of.
void check_inputs_stay(const std::string& exr, const std::vector<std::string>& inputs);

/// Throws UserError when no page of a report can be written there.
void check_report(const std::string& html);

/// Throws UserError when no arrays of NumPy can be written there.
void check_arrays(const std::string& npz);

/// What is wrong with the files that a graph, sound or not, wants to be written (`keep`): they stay in the graph's
/// folder, or below, wherever links lead, and take no place of others.
std::vector<Problem> problems_of_kept_files(const Graph& graph, const Registry& registry);

/// What is wrong with the picture that a graph names: it is taken from the current folder, and stays in that or in the
/// graph's.
std::vector<Problem> problems_of_picture(const Graph& graph, const std::string& file);

}  // namespace lightnet
