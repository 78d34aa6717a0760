#include "reduce/matrices/nastran_dmig.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <utility>

namespace sprung::reduce {

namespace {

constexpr std::size_t kNarrow = 8, kWide = 16, kFieldsOfLine = 8;
constexpr int kSquare = 1, kSymmetric = 6;
constexpr int kLargestRealType = 2;

// What Nastran writes beside the matrices of an external superelement. Anything else may be a matrix's entry
// with a slip of the pen, and is refused.
constexpr std::string_view kOtherEntries[] = {
    "ASET",   "ASET1",  "BEGIN", "BSET",  "BSET1", "CORD1C",  "CORD1R", "CORD1S", "CORD2C",
    "CORD2R", "CORD2S", "CSET",  "CSET1", "DTI",   "ENDDATA", "EXTRN",  "GRID",   "PARAM",
    "PLOTEL", "QSET",   "QSET1", "RSET",  "RSET1", "SECONCT", "SEBULK", "SPOINT", "TABDMP1"};

// A physical line: its first field, and the data after it.
struct Card {
  std::string_view keyword;       // without its '*'; "" for a line that continues another
  std::vector<TextField> fields;  // 4 of a line of wide fields, else 8; blank ones are empty
  bool is_wide = false;
};

std::string_view trim_field(std::string_view text) {
  const std::size_t begin = text.find_first_not_of(" \t\r");
  return begin == text.npos ? std::string_view{}
                            : text.substr(begin, text.find_last_not_of(" \t\r") - begin + 1);
}

std::vector<TextField> cut_fields(std::string_view line, std::size_t width) {
  std::vector<TextField> fields;
  const std::size_t count = width == kWide ? kFieldsOfLine / 2 : kFieldsOfLine;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t begin = kNarrow + i * width;
    if (begin >= line.size()) {
      fields.push_back({{}, static_cast<int>(line.size()) + 1});
      continue;
    }
    const std::string_view field = line.substr(begin, width), text = trim_field(field);
    const std::size_t offset = text.empty() ? begin : static_cast<std::size_t>(text.data() - line.data());
    fields.push_back({text, static_cast<int>(offset) + 1});
  }
  return fields;
}

Card read_card(const TextLines& lines) {
  Card card;
  const std::string_view line = lines.line();
  const bool has_commas = line.find(',') != line.npos;
  std::vector<TextField> cells;
  if (has_commas) cells = lines.cells();
  std::string_view first = trim_field(has_commas ? cells[0].text : line.substr(0, kNarrow));
  card.is_wide = first.find('*') != first.npos;
  if (has_commas) {
    card.fields.assign(cells.begin() + 1, cells.end());
    card.fields.resize(card.is_wide ? kFieldsOfLine / 2 : kFieldsOfLine,
                       {{}, static_cast<int>(line.size()) + 1});
  } else {
    card.fields = cut_fields(line, card.is_wide ? kWide : kNarrow);
  }
  if (!first.empty() && first.front() != '*' && first.front() != '+')
    card.keyword = trim_field(first.substr(0, first.find('*')));
  return card;
}

// The state of reading a file.
class DmigReader {
 public:
  DmigReader(const std::filesystem::path& path, const std::string& name, FreedomList& freedoms)
      : lines_(path), name_(name), freedoms_(freedoms) {
    entries_.path = path.string();
  }

  MatrixEntries read() {
    while (lines_.next()) {
      const std::string_view line = trim_field(lines_.line());
      if (line.empty() || line.front() == '$') continue;
      const Card card = read_card(lines_);
      if (card.keyword == "DMIG") {
        read_first(card);
      } else if (card.keyword.empty()) {
        read_continuation(card);
      } else {
        read_other(card);
      }
    }
    require_matrix();
    return std::move(entries_);
  }

 private:
  // Freedoms are those of the basic system: a grid point may not have another one for its displacements.
  void read_other(const Card& card) {
    const std::string_view keyword = card.keyword.substr(0, card.keyword.find(' '));
    if (std::ranges::find(kOtherEntries, keyword) == std::end(kOtherEntries)) {
      throw lines_.error(fmt::format(
          "'{}' is neither DMIG nor what stands beside the matrices of an external superelement", keyword));
    }
    is_column_ = false;
    is_wide_grid_ = keyword == "GRID" && card.is_wide;
    if (keyword == "GRID" && !card.is_wide) check_system(card.fields[5]);
  }

  void check_system(const TextField& system) const {
    if (system.text.empty() || system.text == "0") return;
    throw lines_.error(system,
                       fmt::format("the point has displacements in the coordinate system {}; expected "
                                   "matrices in the basic system, 0",
                                   system.text));
  }

  void read_first(const Card& card) {
    const std::string found(card.fields[0].text);
    is_column_ = is_wide_grid_ = false;
    if (card.fields[1].text == "0") {
      read_header(card, found);
      return;
    }
    if (found != name_ && !(name_.empty() && found == only_name_)) return;
    if (!has_header_) throw lines_.error(fmt::format("an entry of '{}' stands before its header", found));
    column_ = read_freedom(card.fields[1], card.fields[2]);
    is_column_ = true;
    if (!card.is_wide) read_pair(card.fields, 4);
  }

  // NAME 0 IFO TIN TOUT POLAR blank NCOL
  void read_header(const Card& card, const std::string& found) {
    names_.insert(found);
    if (name_.empty() && names_.size() > 1) {
      throw lines_.error(card.fields[0],
                         fmt::format("is a second matrix, '{}' after '{}': say which one is meant "
                                     "by 'stiffness_name' and 'mass_name'",
                                     found, only_name_));
    }
    if (name_.empty()) only_name_ = found;
    if (!name_.empty() && found != name_) return;
    if (has_header_) throw lines_.error(fmt::format("the matrix '{}' has a second header", found));
    has_header_ = true;
    const std::int64_t form = lines_.integer(card.fields[2], 0, 99);
    if (form != kSquare && form != kSymmetric) {
      throw lines_.error(
          card.fields[2],
          fmt::format("the matrix has the form {}, expected 1 (square) or 6 (symmetric)", form));
    }
    entries_.is_full = form == kSquare;
    const std::int64_t type = lines_.integer(card.fields[3], 1, 4);
    if (type > kLargestRealType) {
      throw lines_.error(card.fields[3],
                         fmt::format("the matrix is complex (type {}), expected 1 or 2", type));
    }
  }

  void read_continuation(const Card& card) {
    if (std::exchange(is_wide_grid_, false)) check_system(card.fields[1]);
    if (!is_column_) return;  // of a header, or of another matrix
    read_pair(card.fields, 0);
    if (!card.is_wide) read_pair(card.fields, 4);
  }

  // A row and its value: node, direction, real part, and the imaginary part, which is blank.
  void read_pair(const std::vector<TextField>& fields, std::size_t at) {
    if (fields[at].text.empty()) return;
    const int row = read_freedom(fields[at], fields[at + 1]);
    if (fields[at + 2].text.empty()) throw lines_.error(fields[at + 2], "the value of the entry is missing");
    if (!fields[at + 3].text.empty() && lines_.real(fields[at + 3]) != 0.0) {
      throw lines_.error(fields[at + 3], "a real matrix has an imaginary part");
    }
    add_entry(lines_, row, column_, fields[at + 2], entries_);
  }

  int read_freedom(const TextField& node, const TextField& direction) {
    const std::int64_t id = lines_.integer(node, 1, std::numeric_limits<std::int32_t>::max());
    const auto number = direction.text.empty() ? 0 : static_cast<int>(lines_.integer(direction, 0, 6));
    const bool is_scalar = number == 0;
    if (is_scalar_.emplace(id, is_scalar).first->second != is_scalar) {
      throw lines_.error(direction,
                         fmt::format("{} is a {} point here, and a {} point in a line before", id,
                                     is_scalar ? "scalar" : "grid", is_scalar ? "grid" : "scalar"));
    }
    return freedoms_.get({id, number});
  }

  void require_matrix() const {
    if (!has_header_) {
      throw lines_.error(name_.empty() ? std::string("has no DMIG matrix")
                                       : fmt::format("has no matrix '{}'", name_));
    }
    if (entries_.items.empty()) throw lines_.error("the matrix has no entries");
  }

  TextLines lines_;
  std::string name_, only_name_;
  FreedomList& freedoms_;
  MatrixEntries entries_;
  std::set<std::string> names_;
  std::map<std::int64_t, bool> is_scalar_;  // of each point so far
  bool has_header_ = false, is_column_ = false, is_wide_grid_ = false;
  int column_ = 0;
};

}  // namespace

MatrixEntries read_nastran_dmig(const std::filesystem::path& path, const std::string& name,
                                FreedomList& freedoms) {
  return DmigReader(path, name, freedoms).read();
}

}  // namespace sprung::reduce
