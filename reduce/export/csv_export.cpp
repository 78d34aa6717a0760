#include "reduce/export/csv_export.h"

#include <fmt/format.h>

#include "reduce/export/text_output.h"
#include "reduce/superelement/superelement_fields.h"

namespace sprung::reduce {

namespace {

// A name as CSV writes it.
std::string quote(const std::string& text) {
  if (text.find_first_of(",\"\n\r") == text.npos) return text;
  std::string quoted = "\"";
  for (const char c : text) quoted += c == '"' ? std::string("\"\"") : std::string(1, c);
  return quoted + "\"";
}

// dataset,matrix,row,column,value: 0-based; vectors are one column.
std::string format_values(const Superelement& s) {
  std::string text = "dataset,matrix,row,column,value\n";
  const FieldCounts counts = count_parts(s);
  for (const SuperelementField& field : superelement_fields(s)) {
    if (field.path.starts_with("/provenance")) continue;
    const FieldValue value = field.member.get(s);
    const std::vector<std::int64_t> extents = calc_extents(field, counts);
    const std::size_t columns = extents.size() > 1 ? static_cast<std::size_t>(extents.back()) : 1;
    for (std::size_t k = 0; k < value.integers.size(); ++k)
      text += fmt::format("{},0,{},{},{}\n", field.path, k / columns, k % columns, value.integers[k]);
    for (std::size_t k = 0; k < value.texts.size(); ++k)
      text += fmt::format("{},0,{},{},{}\n", field.path, k / columns, k % columns, quote(value.texts[k]));
    for (std::size_t matrix = 0; matrix < value.matrices().size(); ++matrix) {
      const support::RowMatrix& numbers = value.matrices()[matrix];
      for (Eigen::Index i = 0; i < numbers.rows(); ++i) {
        for (Eigen::Index j = 0; j < numbers.cols(); ++j)
          text += fmt::format("{},{},{},{},{}\n", field.path, matrix, i, j, format_real(numbers(i, j)));
      }
    }
  }
  return text;
}

}  // namespace

std::string format_node_table(const Superelement& s) {
  std::string text = "node,x,y,point\n";
  for (int node = 0; node < s.num_nodes(); ++node) {
    std::string names;
    for (const NamedPoint& point : s.points) {
      if (point.node == node) names += (names.empty() ? "" : " ") + point.name;
    }
    text += fmt::format("{},{},{},{}\n", s.node_ids[static_cast<std::size_t>(node)],
                        format_real(s.node_positions(0, node)), format_real(s.node_positions(1, node)),
                        quote(names));
  }
  return text;
}

std::string format_freedom_table(const Superelement& s) {
  std::string text = "node,direction\n";
  for (const std::int64_t id : s.node_ids) text += fmt::format("{0},x\n{0},y\n{0},rz\n", id);
  return text;
}

std::string format_mode_table(const Superelement& s) {
  std::string text = "mode,kind,frequency_hz,damping_ratio,cluster\n";
  for (int mode = 0; mode < s.num_modes(); ++mode) {
    text += fmt::format("{},{},{},{},{}\n", mode + 1, s.kind_of(mode), format_real(s.frequency_hz(mode)),
                        format_real(s.damping_ratio(mode)), s.cluster(mode));
  }
  return text;
}

ExportReport export_csv(const Superelement& s, const std::string& prefix) {
  const std::pair<const char*, std::string> files[] = {{"_nodes.csv", format_node_table(s)},
                                                       {"_modes.csv", format_mode_table(s)},
                                                       {"_values.csv", format_values(s)}};
  ExportReport report;
  TextFiles written;
  for (const auto& [ending, text] : files) {
    report.paths.emplace_back(prefix + ending);
    written.add(report.paths.back(), text);
  }
  written.commit();
  report.left_out = {"the design's text and the hashes of its files"};
  return report;
}

}  // namespace sprung::reduce
