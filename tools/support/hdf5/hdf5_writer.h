#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/support/files/temporary_file.h"
#include "tools/support/hdf5/hdf5_growing_dataset.h"
#include "tools/support/hdf5/hdf5_handle.h"
#include "tools/support/hdf5/row_matrix.h"

namespace sprung::support {

/// How the numbers of a growing dataset are stored.
enum class Hdf5Precision {
  kDouble,
  kCompressedSingle,   ///< relative accuracy 6e-8, and 3 bytes or less for a value of a smooth history
  kCompressedRounded,  ///< likewise 8e-6, and 2.5 bytes or less
};

/// Writes an HDF5 file under a temporary name beside the target; `commit` renames it when it is whole.
///
/// Every dataset is chunked, has fletcher32 checksums and no time stamp, so that equal calls give equal
/// bytes. Missing groups of a path are made. A failure (a full disk, a missing folder) throws InputError with
/// the file and the system's reason; after that, the writer can only be destroyed. The destructor removes a
/// file that was not committed or kept, or leaves it under the partial name as the last flush has left it.
/// Writing an object twice, attributes of a missing object, or values that do not fit the shape is a mistake
/// of the caller: std::invalid_argument.
class Hdf5Writer {
 public:
  /// @param target   final name; an existing file of this name stays unchanged until `commit`. The file is
  ///                 written as `target` + ".tmp".
  /// @param partial  name for what is left of a file that does not become complete, in the same folder, or
  ///                 "" for none. `commit` removes a file of this name.
  /// @throws InputError if the folder is missing, the target is not a regular file, or another program is
  ///                    writing it
  explicit Hdf5Writer(std::filesystem::path target, std::filesystem::path partial = {});
  Hdf5Writer(Hdf5Writer&&) = delete;
  ~Hdf5Writer();

  void write(const std::string& dataset, const Eigen::MatrixXd& matrix, std::string_view unit);   ///< rank 2
  void write(const std::string& dataset, std::span<const double> values, std::string_view unit);  ///< rank 1
  /// Any Eigen expression: rank 1 for a row or column vector, rank 2 for a matrix.
  template <typename Derived>
  void write(const std::string& dataset, const Eigen::MatrixBase<Derived>& values, std::string_view unit) {
    if constexpr (Derived::IsVectorAtCompileTime) {
      const Eigen::Matrix<double, Derived::RowsAtCompileTime, Derived::ColsAtCompileTime,
                          Derived::RowsAtCompileTime == 1 ? Eigen::RowMajor : Eigen::ColMajor>
          plain = values;
      write(dataset, std::span<const double>(plain.data(), static_cast<std::size_t>(plain.size())), unit);
    } else {
      write(dataset, Eigen::MatrixXd(values), unit);
    }
  }
  /// An array of any rank, values in row-major order.
  void write(const std::string& dataset, std::span<const double> values,
             const std::vector<std::size_t>& shape, std::string_view unit);
  void write(const std::string& dataset, std::span<const std::int64_t> values);
  void write(const std::string& dataset, std::span<const std::int64_t> values,
             const std::vector<std::size_t>& shape);
  void write(const std::string& dataset, std::span<const std::string> values);  ///< UTF-8 without NUL, rank 1
  void write(const std::string& dataset, std::span<const std::uint8_t> bytes);  ///< rank 1

  void make_group(const std::string& group);
  /// Attributes of a group or dataset; "/" for the file itself. An existing attribute gets the new value, and
  /// keeps its type if it is a number.
  void attribute(const std::string& object, const std::string& name, std::string_view value);
  void attribute(const std::string& object, const std::string& name, double value);
  void attribute(const std::string& object, const std::string& name, std::int64_t value);

  /// An empty dataset of `columns` columns (rank 1 where columns is 0) whose rows grow by `append`.
  /// @param rows  they are collected and written in chunks: memory and file take whole ones
  /// @return valid until `commit` or `keep_partial`
  Hdf5GrowingDataset& make_growing(const std::string& dataset, std::size_t columns, std::string_view unit,
                                   Hdf5Precision precision = Hdf5Precision::kDouble,
                                   const ExpectedRows& rows = {});
  /// Likewise of texts, rank 1. @param text_size  the most bytes of a text: what goes beyond is cut off
  Hdf5GrowingDataset& make_growing_texts(const std::string& dataset, std::size_t text_size);
  /// Appends whole rows, row-major. Rows are collected in chunks, so that an error may appear later.
  void append(Hdf5GrowingDataset& dataset, std::span<const double> values);
  /// Appends the row that has been put into `dataset.next_row()`.
  void finish_row(Hdf5GrowingDataset& dataset) {
    if (dataset.advance()) write_full(dataset);
  }
  void append_text(Hdf5GrowingDataset& dataset, std::string_view text);  ///< UTF-8 without NUL

  /// Writes all that was appended, and the structure of the file. If a later call fails before it has changed
  /// what is there, the destructor leaves the file as it is now under the partial name.
  void flush();
  /// Copies the file, which has just been flushed, to the partial name, so that it can be read even if the
  /// program is killed. Whenever that happens, a file of that name is whole.
  /// @return "" or the error for which there is no new copy, as of a full disk; that of before is still there
  std::string copy_to_partial();

  /// Writes a dataset of doubles anew, which was written before with as many values.
  void overwrite(const std::string& dataset, std::span<const double> values);
  /// Writes a dataset of bytes, or others in its place.
  void overwrite(const std::string& dataset, std::span<const std::uint8_t> bytes);
  void remove(const std::string& object);  ///< a group or dataset that was made before

  /// Closes, syncs and renames to the target. With a partial name, a whole file that cannot be renamed is
  /// left as the temporary one, and the error says so.
  void commit();
  void keep_partial();  ///< closes the file and leaves it under the partial name (an interrupted run)
  /// Has the destructor remove the file, and leave one of the partial name as it is.
  void discard() { is_as_flushed_ = false; }
  const std::filesystem::path& temporary() const { return temporary_.path(); }
  const std::filesystem::path& partial() const { return partial_; }

 private:
  struct Array;
  template <typename Function>
  void attempt(Function&& function);  // HDF5's failures as InputError of this file
  void write_array(const std::string& dataset, const Array& array);
  bool has(const std::string& path) const;
  void make_groups(const std::string& path);
  void prepare_dataset(const std::string& path);
  std::int64_t open(const std::string& path);
  std::int64_t prepare_attribute(const std::string& object);
  void write_full(Hdf5GrowingDataset& dataset);
  void close();
  void rename_to(const std::filesystem::path& name);
  void abandon() noexcept;

  TemporaryFile temporary_;
  std::filesystem::path partial_;
  Hdf5Handle file_;
  Hdf5Handle open_object_;  // at open_path_, if it is open
  std::string open_path_;
  std::set<std::string> objects_;                // paths of the groups and datasets made
  std::vector<std::string> removed_;             // where objects are that the next flush removes
  std::unique_ptr<ChunkCompressor> compressor_;  // where a dataset needs it
  std::map<std::string, Hdf5GrowingDataset> growing_;
  bool is_as_flushed_ = false;       // on the disk, so that it can be read
  std::uintmax_t flushed_size_ = 0;  // of the file then [bytes]
  bool finished_ = false;
};

}  // namespace sprung::support
