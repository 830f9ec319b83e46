#include "tools/pictures/output_file.hpp"

#include <unistd.h>

#include <filesystem>
#include <utility>

#include "core/base/own_files.hpp"
#include "core/film/checkpoint.hpp"
#include "core/film/npz.hpp"
#include "core/network/graph/graph_film.hpp"
#include "core/readers/files/files.hpp"
#include "core/run/assembly/kept.hpp"
#include "tools/support/run_report.hpp"

namespace lightnet {
namespace {

namespace fs = std::filesystem;

std::string folder_of(const std::string& file) {
    const auto folder = fs::path(file).parent_path();
    return folder.empty() ? "." : folder.string();
}

bool really_lies_within(const std::string& folder, const std::string& path) {
    const DiskFiles disk;
    return lies_within(disk.real_path(folder), disk.real_path(path));
}

}  // namespace

void check_output(const std::string& output) {
    const auto folder = folder_of(output);
    if (!has_ending(output, ".exr"))
        throw UserError({output, 0}, "pictures are written as .exr (with a .png beside it)");
    if (!fs::is_directory(folder)) throw UserError({output, 0}, "there is no folder " + folder);
    if (::access(folder.c_str(), W_OK) != 0) throw UserError({output, 0}, "the folder can't be written to");
    std::vector<Problem> problems;
    const auto check = [&](const fs::path& file, std::string_view beginning) {
        if (const auto why = why_not_replaced(file, beginning); !why.empty()) problems.push_back({{file, 0}, why});
    };
    check(output, exr_beginning);
    check(png_beside(output), png_beginning);
    check(report_beside(output), report_beginning);
    check(failed_report_beside(output), report_beginning);
    check(checkpoint_beside(output), checkpoint_beginning);
    if (!problems.empty()) throw UserError(problems);
}

void check_picture(const std::string& exr) {
    std::vector<Problem> problems;
    for (const auto& [file, beginning] :
         {std::pair<fs::path, std::string_view>{exr, exr_beginning}, {png_beside(exr), png_beginning}})
        if (const auto why = why_not_replaced(file, beginning); !why.empty()) problems.push_back({{file, 0}, why});
    if (!problems.empty()) throw UserError(problems);
}

void check_inputs_stay(const std::string& exr, const std::vector<std::string>& inputs) {
    std::vector<Problem> problems;
    for (const auto& file : {fs::path(exr), png_beside(exr)})
        for (const auto& input : inputs) {
            std::error_code not_there;
            if (fs::equivalent(file, input, not_there))
                problems.push_back(
                    {{file, 0}, "is what this picture is made of, and would be lost: choose another --output"});
        }
    if (!problems.empty()) throw UserError(problems);
}

namespace {

void check_file(const std::string& file, std::string_view beginning) {
    const auto folder = folder_of(file);
    if (!fs::is_directory(folder)) throw UserError({file, 0}, "there is no folder " + folder);
    if (::access(folder.c_str(), W_OK) != 0) throw UserError({file, 0}, "the folder can't be written to");
    if (const auto why = why_not_replaced(file, beginning); !why.empty()) throw UserError({file, 0}, why);
}

}  // namespace

void check_report(const std::string& html) { check_file(html, report_page_beginning); }

void check_arrays(const std::string& npz) { check_file(npz, npz_beginning); }

// DECISIONS: where-graphs-write
std::vector<Problem> problems_of_kept_files(const Graph& graph, const Registry& registry) {
    std::vector<Problem> problems;
    for (const auto& node : graph.nodes) {
        const Kind* kind = registry.find(node.kind);
        const auto param = node.params.find("keep");
        if (!kind || !kind->run.keeps || param == node.params.end()) continue;
        const auto* name = std::get_if<std::string>(&param->second.data);
        if (!name || name->empty()) continue;
        const auto file = beside_graph(graph, *name);
        const auto complain = [&](const std::string& what) {
            problems.push_back({node.where, node.kind + " '" + node.name + "': 'keep': '" + file + "' " + what});
        };
        if (const auto why = why_not_replaced(file, kept_beginning); !really_lies_within(folder_of(graph.file), file))
            complain("is outside of the graph's folder, where graphs write nothing");
        else if (!why.empty())
            complain(why);
    }
    return problems;
}

std::vector<Problem> problems_of_picture(const Graph& graph, const std::string& file) {
    if (really_lies_within(".", file) || really_lies_within(folder_of(graph.file), file)) return {};
    return {{{graph.file, 0},
             "the film's file '" + file + "' is outside of this folder and of the graph's: choose that with -o"}};
}

}  // namespace lightnet
