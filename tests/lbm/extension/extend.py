"""Adds a collision operator, a subgrid model and a wall to a copy of lbm/: extend.py REPOSITORY COPY.

The edits are those of somebody who adds one, in the files that CONTRIBUTING.md names. The compiler asks for every
`case` that is left out. extension_test.cpp compares the results with analytic solutions.
"""
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import extended_copy

# File of lbm/, its text, the text in place of that.
COLLISION_OPERATOR = [
    ("collision/collision_model.hpp", "enum class CollisionModel { bgk, trt, trt_at_bodies };",
     "enum class CollisionModel { bgk, trt, trt_at_bodies, odd_at_once };"),
    ("collision/collision_model.hpp", "CollisionModel::trt, CollisionModel::trt_at_bodies};",
     "CollisionModel::trt, CollisionModel::trt_at_bodies,\n"
     "                                           CollisionModel::odd_at_once};"),
    ("collision/collision_model.hpp", "    case CollisionModel::bgk:\n      return {",
     "    case CollisionModel::odd_at_once:\n"
     '      return {"odd_at_once", "the odd part relaxes in one step", false, false, 3.0 / 16.0, bulk_bgk};\n'
     "    case CollisionModel::bgk:\n      return {"),
    ("collision/collision_model.hpp", "    case CollisionModel::bgk:\n      return visit",
     "    case CollisionModel::odd_at_once:\n"
     "      return visit.template operator()<CollisionModel::odd_at_once>();\n"
     "    case CollisionModel::bgk:\n      return visit"),
    ("collision/collision.hpp", "  if constexpr (model == CollisionModel::bgk) {",
     "  if constexpr (model == CollisionModel::odd_at_once) {\n"
     "    relax_trt<with_bulk>(f, m, constants, pack_constant<Number>(1));\n"
     "  } else if constexpr (model == CollisionModel::bgk) {"),
]

# Smagorinsky's model from the shear alone: nu_t = 2 C^2 sqrt(S_xy^2 + S_xz^2 + S_yz^2), so E = 36 C^2 sqrt(sum
# Pi_ab^2).
SUBGRID_MODEL = [
    ("collision/subgrid.hpp", "enum class SubgridModel { none, smagorinsky, qr };",
     "enum class SubgridModel { none, smagorinsky, qr, shear };"),
    ("collision/subgrid.hpp", "    case SubgridModel::none:\n      return visit",
     "    case SubgridModel::shear:\n"
     "      return visit.template operator()<SubgridModel::shear>();\n"
     "    case SubgridModel::none:\n      return visit"),
    ("collision/subgrid.hpp", "  static Subgrid qr()",
     "  static Subgrid shear(double constant) { return {SubgridModel::shear, constant}; }\n  static Subgrid qr()"),
    ("collision/subgrid.hpp", "      case SubgridModel::smagorinsky:\n        return constant_ * constant_ * rate;",
     "      case SubgridModel::shear:\n"
     "      case SubgridModel::smagorinsky:\n        return constant_ * constant_ * rate;"),
    ("collision/subgrid.hpp", "      case SubgridModel::qr:\n        return 36.0 * constant_;",
     "      case SubgridModel::shear:\n        return 36.0 * constant_ * constant_;\n"
     "      case SubgridModel::qr:\n        return 36.0 * constant_;"),
    ("collision/subgrid.hpp", "  if constexpr (model == SubgridModel::smagorinsky) {",
     "  if constexpr (model == SubgridModel::shear) {\n"
     "    return sqrt(pi.xy * pi.xy + pi.xz * pi.xz + pi.yz * pi.yz);\n"
     "  } else if constexpr (model == SubgridModel::smagorinsky) {"),
    ("collision/subgrid.cpp", "          {SubgridModel::none,",
     '          {SubgridModel::shear, "shear", "from the shear alone"},\n          {SubgridModel::none,'),
]

# Half of what comes bounces back, half is mirrored: a slip length of tau - 1/2 (walls.hpp).
WALL = [
    ("walls/boundary.hpp", "enum class FaceType {\n", "enum class FaceType {\n  half_slip,\n"),
    ("walls/boundary.hpp", "enum class Reflection {\n", "enum class Reflection {\n  half,\n"),
    ("walls/boundary.hpp", "  switch (type) {\n",
     "  switch (type) {\n"
     "    case FaceType::half_slip:\n      return {.reflection = Reflection::half, .drags = true};\n"),
    ("walls/wall_rules.cpp", "  switch (reflection) {\n",
     "  switch (reflection) {\n"
     "    case Reflection::half:\n"
     "      for (int u = part.begin; u < part.end; ++u) {\n"
     "        const Real mean = Real(0.5) * (own[u * stride] + other[u * stride]);\n"
     "        into[u * stride] = body[u * stride] == CellMap::fluid ? mean : own[u * stride];\n"
     "      }\n"
     "      break;\n"),
]


if __name__ == "__main__":
    extended_copy.write(pathlib.Path(sys.argv[1]), pathlib.Path(sys.argv[2]), "lbm",
                        COLLISION_OPERATOR + SUBGRID_MODEL + WALL, {})
