"""Decks of two and of one line, for tests to spoil or to add to."""

ABAQUS = "*NODE\n1, 0., 0., 0.\n2, 1., 0., 0.\n3, 1., 1., 0.\n*ELEMENT, TYPE=B21, ELSET=A\n1, 1, 2\n2, 2, 3\n"
NASTRAN = "BEGIN BULK\nGRID,1,,0.,0.,0.\nGRID,2,,1.,0.,0.\nCBAR,1,1,1,2,0.,1.,0.\nENDDATA\n"
