#include "reduce/matrices/abaqus_substructure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <limits>

#include "reduce/matrices/abaqus_matrix.h"

namespace sprung::reduce {

namespace {

// A line of keywords in capitals and without blanks: "*USERELEMENT,NODES=4,LINEAR".
std::string make_plain_keywords(std::string_view line) {
  std::string plain;
  for (const char c : line) {
    const auto byte = static_cast<unsigned char>(c);
    if (std::isspace(byte) == 0) plain += static_cast<char>(std::toupper(byte));
  }
  return plain;
}

bool is_comment(const TextLines& lines) {
  return lines.line().starts_with("**");
}

class SubstructureReader {
 public:
  SubstructureReader(const std::filesystem::path& path, const std::string& type, FreedomList& freedoms,
                     bool given)
      : lines_(path),
        type_(type),
        freedoms_(freedoms),
        given_(given),
        entries_{.path = path.string(), .items = {}} {}

  MatrixEntries read() {
    while (lines_.next()) {
      if (is_comment(lines_)) {
        read_comment();
      } else if (lines_.line().starts_with("*")) {
        read_keywords();
      } else if (!lines_.fields().empty()) {
        read_numbers();
      }
    }
    finish_matrix();
    if (!found_) throw lines_.error(fmt::format("has no *MATRIX, TYPE={}", type_));
    return std::move(entries_);
  }

 private:
  enum class Part { kStart, kDirections, kMatrix, kOtherMatrix };

  // The nodes stand in comments after "** ELEMENT NODES". What Abaqus remarks behind them has no numbers.
  void read_comment() {
    if (part_ != Part::kDirections) return;
    if (make_plain_keywords(lines_.line()) == "**ELEMENTNODES") {
      in_nodes_ = true;
      return;
    }
    if (!in_nodes_ || static_cast<std::int64_t>(nodes_.size()) == num_nodes_) return;
    for (TextField field : lines_.fields()) {
      const std::size_t stars = std::min(field.text.find_first_not_of('*'), field.text.size());
      field.text.remove_prefix(stars);
      field.column += static_cast<int>(stars);
      if (field.text.empty()) continue;
      constexpr std::int64_t kLargest = std::numeric_limits<std::int32_t>::max();
      nodes_.push_back(lines_.integer(field, -kLargest, kLargest));
    }
  }

  void read_keywords() {
    const std::string plain = make_plain_keywords(lines_.line());
    in_nodes_ = false;
    finish_matrix();
    if (plain.starts_with("*USERELEMENT,") && part_ == Part::kStart) {
      if (plain.find(",UNSYMM") != plain.npos)
        throw lines_.error("the element is unsymmetric, expected a symmetric one");
      part_ = Part::kDirections;
      num_nodes_ = read_count(plain);
    } else if (plain.starts_with("*USERELEMENT,")) {
      throw lines_.error("is a second element, expected the matrices of one substructure");
    } else if (plain.starts_with("*MATRIX,TYPE=") && part_ != Part::kStart) {
      begin_matrix(plain.substr(plain.find('=') + 1));
    } else {
      throw lines_.error(fmt::format(
          "'{}' is no part of a substructure, expected *USER ELEMENT, then *MATRIX, TYPE=…", lines_.line()));
    }
  }

  void read_numbers() {
    if (part_ == Part::kStart) throw lines_.error("stands before *USER ELEMENT");
    if (part_ == Part::kDirections) return read_directions();
    if (part_ == Part::kOtherMatrix) return;
    for (const TextField& field : lines_.fields()) {
      if (row_ == rows_.size()) throw lines_.error(field, describe_count("more than"));
      add_entry(lines_, rows_[row_], rows_[column_], field, entries_);
      ++column_;
      if (column_ > row_) {
        ++row_;
        column_ = 0;
      }
    }
  }

  // n of NODES=n, 0 where there is none.
  static std::int64_t read_count(std::string_view plain) {
    constexpr std::string_view kNodes = ",NODES=";
    const std::size_t at = plain.find(kNodes);
    std::int64_t count = 0;
    if (at != plain.npos)
      std::from_chars(plain.data() + at + kNodes.size(), plain.data() + plain.size(), count);
    return count;
  }

  // "1, 2, 6": the directions of the first node and of those after it; "3, 1, 2": from the third node on
  // 1, 2.
  void read_directions() {
    in_nodes_ = false;
    const std::vector<TextField> fields = lines_.fields();
    const auto num_nodes = static_cast<std::int64_t>(nodes_.size());
    if (num_nodes != num_nodes_ || num_nodes == 0) {
      throw lines_.error(
          fmt::format("{} nodes stand in the comments after '** ELEMENT NODES', expected NODES={}", num_nodes,
                      num_nodes_));
    }
    const bool is_first = next_node_ == 0;
    const std::int64_t begin = is_first ? 1 : lines_.integer(fields[0], next_node_ + 1, num_nodes);
    fill_up_to(begin - 1);
    directions_.clear();
    for (std::size_t i = is_first ? 0 : 1; i < fields.size(); ++i)
      directions_.push_back(static_cast<int>(lines_.integer(fields[i], 1, 6)));
    if (directions_.empty()) throw lines_.error(fields[0], "has no direction after the node's position");
    add_node();
  }

  // The nodes up to there have the directions that stand before.
  void fill_up_to(std::int64_t end) {
    while (next_node_ < end) add_node();
  }
  void add_node() {
    const std::int64_t node = nodes_[static_cast<std::size_t>(next_node_++)];
    for (const int direction : directions_)
      rows_.push_back(given_ ? static_cast<int>(rows_.size()) : find_row(node, direction));
  }
  int find_row(std::int64_t node, int direction) const {
    const Freedom freedom = make_abaqus_freedom(node, direction);
    const int row = freedoms_.get(freedom);
    if (std::find(rows_.begin(), rows_.end(), row) == rows_.end()) return row;
    throw lines_.error(
        fmt::format("{} stands in the list twice; name the rows in a table 'freedoms'", describe(freedom)));
  }

  void begin_matrix(const std::string& type) {
    if (part_ == Part::kDirections) {
      if (directions_.empty()) throw lines_.error("expected the directions of the nodes before");
      fill_up_to(static_cast<std::int64_t>(nodes_.size()));
      if (given_ && static_cast<int>(rows_.size()) != freedoms_.size()) {
        throw lines_.error(fmt::format("the substructure has {} freedoms, and the table 'freedoms' has {}",
                                       rows_.size(), freedoms_.size()));
      }
    }
    part_ = type == type_ ? Part::kMatrix : Part::kOtherMatrix;
    if (part_ != Part::kMatrix) return;
    if (found_) throw lines_.error(fmt::format("*MATRIX, TYPE={} stands in the file twice", type_));
    found_ = true;
    row_ = column_ = 0;
  }
  void finish_matrix() {
    if (part_ == Part::kMatrix && row_ != rows_.size()) throw lines_.error(describe_count("less than"));
  }
  std::string describe_count(std::string_view comparison) const {
    const std::size_t n = rows_.size();
    return fmt::format("the matrix has {} {} values, as {} freedoms need for one triangle", comparison,
                       n * (n + 1) / 2, n);
  }

  TextLines lines_;
  std::string type_;
  FreedomList& freedoms_;
  bool given_;
  MatrixEntries entries_;
  Part part_ = Part::kStart;
  bool in_nodes_ = false, found_ = false;
  std::vector<std::int64_t> nodes_;
  std::int64_t num_nodes_ = 0,
               next_node_ = 0;  // told by the keywords; the first whose directions are not known
  std::vector<int> directions_;
  std::vector<int> rows_;             // of the matrix, for each row of the file
  std::size_t row_ = 0, column_ = 0;  // of the next value
};

}  // namespace

bool is_abaqus_substructure(const std::filesystem::path& path) {
  TextLines lines(path);
  while (lines.next()) {
    if (is_comment(lines) || lines.fields().empty()) continue;
    return make_plain_keywords(lines.line()).starts_with("*USERELEMENT,");
  }
  return false;
}

MatrixEntries read_abaqus_substructure(const std::filesystem::path& path, const std::string& type,
                                       FreedomList& freedoms, bool given) {
  return SubstructureReader(path, type, freedoms, given).read();
}

}  // namespace sprung::reduce
