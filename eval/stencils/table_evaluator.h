// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "eval/stencils/stencil_evaluator.h"
#include "far_ext/rows/sparse_rows.h"

namespace limn::eval {

/// What a table is, and how often it was applied.
struct TableUse {
    std::string what;  ///< e.g. "S1", of all levels together
    size_t rows = 0, entries = 0, applications = 0;
    double seconds = 0.0;  ///< of applying
};

class TableEvaluator;

/// A fixed table of weights that its evaluator applies, in float. As long as the evaluator lives.
class FixedTable {
public:
    Index GetNumRows() const { return _stencils.GetNumStencils(); }

    /// y = table x, of `length` numbers per row that lie one after another; of a table with
    /// derivatives, all rows of each weight set after those of the one before.
    ///
    /// \param origin  `length` numbers that are taken off x and added to the values; for tables
    ///                whose rows add up to 1, which so lose nothing far from 0. May be null
    /// \throws Error  BadMesh: a number that float cannot hold; BadOption: arrays too short
    void Apply(std::span<double const> x, int length, std::span<double> y,
               double const* origin = nullptr) const;

private:
    friend class TableEvaluator;
    FixedTable(TableEvaluator& evaluator, size_t use, far_ext::StencilRows rows);

    TableEvaluator* _evaluator;
    size_t _use;  // its number among the evaluator's
    Index _numColumns;
    int _numSets;
    StencilEvaluator _stencils;
};

/// The door through which a run's fixed tables are applied, by one evaluator, and counted by what
/// they are.
///
/// Threads  Tables are made by one thread at a time; applied by any.
class TableEvaluator {
public:
    explicit TableEvaluator(EvaluatorKind kind) : _kind(kind) {}
    virtual ~TableEvaluator() = default;
    TableEvaluator(TableEvaluator const&) = delete;
    TableEvaluator& operator=(TableEvaluator const&) = delete;

    EvaluatorKind GetKind() const { return _kind; }

    /// \param what     tables of one name are counted together
    /// \throws Error   as far_ext::Validate
    FixedTable Make(std::string const& what, far_ext::StencilRows rows);

    /// The same, rounded to float. \throws Error  TooLarge: more than 2^31 entries
    FixedTable Make(std::string const& what, far_ext::SparseRows const& rows, Index numColumns);

    /// In the order in which their names came.
    std::vector<TableUse> GetUses() const;

protected:
    /// All rows of a table. Others may watch here, or do it in their own way.
    virtual void Apply(std::string const& what, StencilEvaluator const& table, float const* source,
                       Osd::BufferDescriptor const& desc,
                       SimdEvaluator::Targets const& targets) const;

private:
    friend class FixedTable;
    std::string GetName(size_t use) const;
    void Count(size_t use, double seconds);

    EvaluatorKind _kind;
    mutable std::mutex _mutex;
    std::vector<TableUse> _uses;
};

/// rows x, one number per row, in double; or once through an evaluator.
///
/// \param evaluator  null: none. \param what  as TableEvaluator::Make
/// \throws Error     as TableEvaluator::Make, FixedTable::Apply
std::vector<double> ApplyRows(TableEvaluator* evaluator, std::string const& what,
                              far_ext::SparseRows const& rows, std::vector<double> const& x);

}  // namespace limn::eval
