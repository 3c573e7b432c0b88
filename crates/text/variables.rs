//! Finds the variables in a Fluent pattern, for the build script and the tests of the catalogs.

use fluent_syntax::ast::{CallArguments, Expression, InlineExpression, Pattern, PatternElement};
use std::collections::BTreeSet;

/// Returns the names of the variables in a pattern.
pub fn variables(pattern: &Pattern<String>) -> BTreeSet<String> {
    let mut variables = BTreeSet::new();
    collect_pattern(pattern, &mut variables);
    variables
}

fn collect_pattern(pattern: &Pattern<String>, variables: &mut BTreeSet<String>) {
    for element in &pattern.elements {
        if let PatternElement::Placeable { expression } = element {
            collect_expression(expression, variables);
        }
    }
}

fn collect_expression(expression: &Expression<String>, variables: &mut BTreeSet<String>) {
    match expression {
        Expression::Inline(inline) => collect_inline(inline, variables),
        Expression::Select { selector, variants } => {
            collect_inline(selector, variables);
            variants.iter().for_each(|variant| collect_pattern(&variant.value, variables));
        }
    }
}

fn collect_inline(inline: &InlineExpression<String>, variables: &mut BTreeSet<String>) {
    match inline {
        InlineExpression::VariableReference { id } => drop(variables.insert(id.name.clone())),
        InlineExpression::Placeable { expression } => collect_expression(expression, variables),
        InlineExpression::FunctionReference { arguments, .. } => collect_arguments(arguments, variables),
        InlineExpression::TermReference { arguments, .. } => {
            arguments.iter().for_each(|arguments| collect_arguments(arguments, variables));
        }
        InlineExpression::StringLiteral { .. }
        | InlineExpression::NumberLiteral { .. }
        | InlineExpression::MessageReference { .. } => {}
    }
}

fn collect_arguments(arguments: &CallArguments<String>, variables: &mut BTreeSet<String>) {
    arguments.positional.iter().for_each(|argument| collect_inline(argument, variables));
    arguments.named.iter().for_each(|argument| collect_inline(&argument.value, variables));
}
