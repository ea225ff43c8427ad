// A word of a choice in a case file and what it means. The words of an enumeration E are those of
//
//   std::vector<NamedChoice<E>> choices_of(E)
//
// in E's namespace (section_visitor.hpp).
#pragma once

#include <string>

namespace thalweg {

template <typename Choice>
struct NamedChoice {
  Choice value;
  std::string name;
  std::string meaning = {};
};

}  // namespace thalweg
