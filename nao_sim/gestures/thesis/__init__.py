"""The figures that the thesis published, beside what its learners make of the printed rows."""
