// Distribution of data of an observer over the ranks by the grain's id: every rank is home to one range of ids, and
// stores what the observer remembers of these grains from one measurement to the next. Each measurement sends a few
// numbers of every grain from its owner to its home. Owners may then change freely, a checkpoint is written in the
// order of ids on any number of ranks, and no rank stores more than its share of all grains.
#pragma once

#include "core/base/archive.hpp"
#include "core/base/types.hpp"
#include "core/parallel/mpi_session.hpp"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace thalweg::analysis {

class DistributionById {
public:
  // count: ids are 0 ... count - 1.
  DistributionById(MPI_Comm communicator, GlobalId count) : communicator_(communicator), count_(count) {
    const int ranks = thalweg::size_of(communicator);
    share_ = std::max<GlobalId>(1, (count + ranks - 1) / ranks);
    begin_ = std::min(count, share_ * thalweg::rank_of(communicator));
    end_ = std::min(count, begin_ + share_);
  }

  GlobalId count() const { return count_; }
  GlobalId begin() const { return begin_; }  // first id whose home is here
  std::size_t size() const { return static_cast<std::size_t>(end_ - begin_); }
  std::size_t location_of(GlobalId id) const { return static_cast<std::size_t>(id - begin_); }  // among those here

  // Rows have a member `id`; each comes to the home of its id. In no particular order. Collective.
  template <typename Row>
  std::vector<Row> bring_home(const std::vector<Row>& rows) const {
    std::vector<int> home;
    home.reserve(rows.size());
    for (const Row& row : rows) home.push_back(static_cast<int>(row.id / share_));
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

  // This rank's part of an array with `columns` numbers for each id.
  ArrayBox box(std::uint64_t columns) const {
    return {{static_cast<std::uint64_t>(count_), columns},
            {static_cast<std::uint64_t>(begin_), 0},
            {static_cast<std::uint64_t>(size()), columns}};
  }

private:
  MPI_Comm communicator_;
  GlobalId count_, share_ = 1, begin_ = 0, end_ = 0;
};

}  // namespace thalweg::analysis
