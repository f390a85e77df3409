//! Worked out by hand.

use super::*;

const A: Matrix3 = [[1.0, 2.0, 3.0], [4.0, 5.0, 6.0], [7.0, 8.0, 9.0]];
const B: Matrix3 = [[0.0, 2.0, 0.0], [0.0, 0.0, 4.0], [6.0, 0.0, 0.0]];

#[test]
fn rows_become_columns() {
    assert_eq!(
        transposed(A),
        [[1.0, 4.0, 7.0], [2.0, 5.0, 8.0], [3.0, 6.0, 9.0]]
    );
}

#[test]
fn a_scaled_matrix_is_added() {
    assert_eq!(
        add_scaled(&A, -0.5, &B),
        [[1.0, 1.0, 3.0], [4.0, 5.0, 4.0], [4.0, 8.0, 9.0]]
    );
}
