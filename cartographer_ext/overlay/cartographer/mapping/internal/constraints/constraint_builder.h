// SPDX-FileCopyrightText: 2026 The cartographer_ext authors
// SPDX-License-Identifier: Apache-2.0
//
// Comes before Cartographer's header of the same path: the stock factory
// becomes StockCreateConstraintBuilderOptions, and the one of the original
// name also reads our block.
#pragma GCC system_header

#include "cartographer_ext/swaps.h"

#if !defined(CARTOGRAPHER_EXT_SWAP_CONSTRAINT_BUILDER) || \
    defined(CreateConstraintBuilderOptions)
// Not selected, or this is the stock source with its function renamed.
#include_next "cartographer/mapping/internal/constraints/constraint_builder.h"
#else
#ifndef CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_H_
#define CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_H_

#define CreateConstraintBuilderOptions StockCreateConstraintBuilderOptions
#include_next "cartographer/mapping/internal/constraints/constraint_builder.h"
#undef CreateConstraintBuilderOptions

namespace cartographer {
namespace mapping {
namespace constraints {

proto::ConstraintBuilderOptions CreateConstraintBuilderOptions(
    common::LuaParameterDictionary* parameter_dictionary);

}  // namespace constraints
}  // namespace mapping
}  // namespace cartographer

#endif  // CARTOGRAPHER_EXT_OVERLAY_CONSTRAINT_BUILDER_H_
#endif
