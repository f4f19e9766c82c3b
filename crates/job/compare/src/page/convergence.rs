//! The page about the convergence of relaxations: charts and tables.

use super::markup::{image_source, table};
use super::{foot, head, section};
use crate::Convergence;

impl Convergence {
    /// Returns the page as a self-contained file without scripts. The same data give the same bytes.
    pub fn to_html(&self) -> String {
        let [rows, columns] = self.cells;
        let subtitle = format!("Relaxations on {rows} x {columns} cells, {} of them free", self.free);
        let charts = format!(
            "<figure class=\"picture\" tabindex=\"0\"><img alt=\"Errors and sweeps\" src=\"{}\"/></figure>\n",
            image_source(&self.figure().svg())
        );
        head(&self.title, &subtitle, "", false)
            + &section("Charts", &charts)
            + &section("Relaxations", &table(&self.table()))
            + &section("Sweeps of SOR by its factor", &table(&self.factor_table()))
            + &section("Sweeps of weighted Jacobi by its factor", &table(&self.weight_table()))
            + &self.describe_leap()
            + &section("Sweeps of Gauss-Seidel by epsilon", &table(&self.strength_table()))
            + &foot(METHOD_NOTE)
    }

    /// Describes the jump of the changes at the point where preferences are added, if there is one.
    fn describe_leap(&self) -> String {
        let leaps = self.leap_table();
        if leaps.rows.is_empty() { String::new() } else { section("Where preferences begin", &table(&leaps)) }
    }
}

const METHOD_NOTE: &str = "The error of a field is its greatest difference from the solution by elimination, divided by the same difference before the first sweep. The rate is the factor by which a late sweep multiplies the error. The factor by formula is the best one for Laplace's equation in an empty rectangle. The factor by rate is Young's; it follows from the rate of Jacobi's relaxation on this grid. The charts have no points for relaxations that diverge or end before they converge.";
