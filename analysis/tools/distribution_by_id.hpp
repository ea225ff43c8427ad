// Distribution of data of an observer over the ranks by the grain's id: every rank is home to one range of ids, and
// stores what the observer remembers of these grains from one measurement to the next. Each measurement sends a few
// numbers of every grain from its owner to its home. Owners may then change freely, a checkpoint is written in the
// order of ids on any number of ranks, and no rank stores more than its share of all grains. Where ids are added
// because grains come in, every rank gets further ranges, one after the other as at the start: what is stored stays
// where it is.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/types.hpp"
#include "core/parallel/mpi_session.hpp"
#include "core/parallel/row_range.hpp"
#include "core/parallel/wide_rows.hpp"
#include "core/state/whole_dataset.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <span>
#include <string>
#include <vector>

namespace thalweg::analysis {

class DistributionById {
public:
  // count: ids are 0 ... count - 1.
  DistributionById(MPI_Comm communicator, GlobalId count)
      : communicator_(communicator),
        ranks_(thalweg::size_of(communicator)),
        rank_(thalweg::rank_of(communicator)),
        count_(count),
        share_(std::max<GlobalId>(1, (count + ranks_ - 1) / ranks_)) {}

  // As many ids as the array at `path` has rows. fewest: bodies that an observer remembers. Throws DamagedFile if there
  // are fewer rows. Collective.
  static DistributionById of_rows(MPI_Comm communicator, ArchiveReader& archive, const std::string& path,
                                  std::int64_t fewest = 0) {
    const auto rows = static_cast<GlobalId>(archive.shape(path).at(0));
    if (rows < fewest)
      throw damaged_dataset(path, fmt::format("the file holds {} grains, but {} were measured", rows, fewest));
    return {communicator, rows};
  }

  // Adds ids up to count - 1; those that are stored here stay the first of size().
  void grow(GlobalId count) { count_ = std::max(count_, count); }

  GlobalId count() const { return count_; }
  std::size_t size() const {
    const GlobalId cycle = share_ * ranks_, whole = count_ / cycle, rest = count_ % cycle - share_ * rank_;
    return static_cast<std::size_t>(whole * share_ + std::clamp<GlobalId>(rest, 0, share_));
  }
  // Place of an id whose home is here among those that are stored here, and the id at a place.
  std::size_t location_of(GlobalId id) const {
    return static_cast<std::size_t>(id / (share_ * ranks_) * share_ + id % share_);
  }
  GlobalId id_at(std::size_t place) const {
    const auto n = static_cast<GlobalId>(place);
    return n / share_ * share_ * ranks_ + share_ * rank_ + n % share_;
  }
  int home_of(GlobalId id) const { return static_cast<int>(id / share_ % ranks_); }

  // Rows have a member `id`; each comes to the home of its id. In no particular order. Collective.
  template <typename Row>
  std::vector<Row> bring_home(const std::vector<Row>& rows) const {
    std::vector<int> home;
    home.reserve(rows.size());
    for (const Row& row : rows) home.push_back(home_of(row.id));
    return exchange_rows(communicator_, rows, home);
  }

  // Answers of the homes to questions about these ids, in their order: answer(id) is called at the home of the id.
  // Answers are trivially copyable. Collective.
  template <typename Answer>
  auto ask(std::span<const GlobalId> ids, const Answer& answer) const {
    using Value = decltype(answer(GlobalId{}));
    struct Question {
      GlobalId id;
      std::int64_t place;  // among the ids
      int rank;            // the one that asks
    };
    struct Reply {
      std::int64_t place;
      Value value;
    };
    std::vector<Question> questions;
    for (const GlobalId id : ids)
      questions.push_back({id, static_cast<std::int64_t>(questions.size()), thalweg::rank_of(communicator_)});
    std::vector<Reply> replies;
    std::vector<int> to;
    for (const Question& question : bring_home(questions)) {
      replies.push_back({question.place, answer(question.id)});
      to.push_back(question.rank);
    }
    std::vector<Value> values(ids.size());
    for (const Reply& reply : exchange_rows(communicator_, replies, to))
      values[static_cast<std::size_t>(reply.place)] = reply.value;
    return values;
  }

  // Writes and reads an array with `columns` numbers for each id, in the order of ids. values: of those stored here.
  // Collective.
  template <typename Number>
  void write(ArchiveWriter& archive, const std::string& path, std::vector<Number> values, std::size_t columns) const {
    const RowRange rows = is_one_range() ? own_range() : RowRange(count_, ranks(), static_cast<int>(rank_));
    if (!is_one_range()) values = in_order_of_ids(std::move(values), columns);
    archive.write(path, std::span<const Number>(values), rows.box(columns));
  }
  template <typename Number>
  std::vector<Number> read(ArchiveReader& archive, const std::string& path, std::size_t columns) const {
    std::vector<Number> values(size() * columns);
    archive.read(path, std::span<Number>(values), own_range().box(columns));
    return values;
  }

  // Rows of ids whose home is here, in their order, as rows that rise with the id through the ranks. Collective.
  template <typename Row>
  std::vector<Row> in_order_of_ids(std::vector<Row> rows) const {
    if (is_one_range()) return rows;
    std::vector<int> to;
    for (const Row& row : rows) to.push_back(rank_of_row(row.id, count_, ranks()));
    rows = exchange_rows(communicator_, rows, to);
    std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.id < b.id; });
    return rows;
  }

private:
  int ranks() const { return static_cast<int>(ranks_); }
  bool is_one_range() const { return count_ <= share_ * ranks_; }
  RowRange own_range() const {
    RowRange range(count_, 1, 0);
    range.first = std::min(count_, share_ * rank_);
    range.last = std::min(count_, range.first + share_);
    return range;
  }
  template <typename Number>
  std::vector<Number> in_order_of_ids(std::vector<Number> values, std::size_t columns) const {
    struct Id {
      GlobalId id;
    };
    std::vector<Id> ids;
    std::vector<int> to;
    for (std::size_t place = 0; place < size(); ++place) {
      ids.push_back({id_at(place)});
      to.push_back(rank_of_row(ids.back().id, count_, ranks()));
    }
    ids = exchange_rows(communicator_, ids, to);
    values = exchange_wide_rows(communicator_, std::move(values), columns, to);
    std::vector<std::size_t> order(ids.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return ids[a].id < ids[b].id; });
    std::vector<Number> sorted;
    for (const std::size_t row : order)
      for (std::size_t c = 0; c < columns; ++c) sorted.push_back(values[row * columns + c]);
    return sorted;
  }

  MPI_Comm communicator_;
  GlobalId ranks_, rank_, count_, share_;
};

}  // namespace thalweg::analysis
